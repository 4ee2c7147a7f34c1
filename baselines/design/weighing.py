"""The law that weighs hypotheses by what is read: a filter and a regulator for each, and one voltage from all of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import ceil, prod
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.design.controller import Array
from baselines.design.filter_bank import FilterBank
from baselines.design.law import Law
from baselines.design.linear import LinearController
from baselines.design.matrix import keep_matrices
from baselines.design.motion import Motion, motion_of
from baselines.design.objects import instance

AT_ONCE = 2**20
"""Numbers of memories that are worked on at once: larger arrays in between would be asked of the system anew at every instant."""


class Memory(NamedTuple):
    """What is remembered of N blades, views of the rows of one array."""

    predicted: Array
    """(N, H, s); within the law (N, size), in the coordinates of its motion."""
    evidence: Array
    """(N, H): logarithm of each hypothesis' weight over that beforehand."""
    squared: Array
    """(N, H): normalised innovations squared, fading."""
    voltages: Array
    """(N, D, m), V, as applied, newest first."""
    reading: Array
    """(N, p), A."""
    own: Array
    """(N, r): the fallback's."""
    instant: Array
    """(N,)."""
    readings: Array
    """(N,): how many there were, fading as their squares do."""
    astray: Array
    """(N,): 1 where the fallback is in charge."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MultipleModel(Law):
    """Voltages that each hypothesis' regulator asks for from its own filter's estimate, in shares that are its probability.

    With x̂_h the filtered estimate of hypothesis h, w_h its weight and p(y | h) the density of a reading by its filter,

        w_h ∝ w_h p(y | h),        u = Σ w_h clip(−K_h [x̂_h; voltages before]),        x̂_h⁺ = A_h x̂_h + B_h [u; voltages before].

    With a Markov matrix the weights and estimates are mixed before they are predicted, as in the interacting multiple-model
    estimator, with gains that know of no change: x̂_j ← Σ_i Π_ij w_i x̂_i / w_j, w_j ← Σ_i Π_ij w_i.
    """

    bank: FilterBank
    """The filters."""
    state_gain: Array
    """(H, m, s), V: of filtered estimates."""
    voltage_gain: Array
    """(H, m, m D): of the D voltages before, newest first."""
    prior: Array
    """(H,): probabilities beforehand, which add up to 1."""
    transition: Array | None
    """Π (H, H): probability that i (row) is followed by j, from one instant to the next; None: what is the case stays so."""
    floor: float
    """Least weight."""
    fallback: LinearController | None
    """The law that is in charge where no hypothesis fits."""
    window: int
    """Instants over which the test of fit remembers."""
    misfit: float
    """Mean normalised innovation squared over the number of readings from which on no hypothesis fits; 1 where one is right."""
    _motion: Motion = field(init=False)
    """How predictions go on."""
    _log_prior: Array = field(init=False)
    """(H,)."""
    _before: Array = field(init=False)
    """(H, m D, m): transposed ``voltage_gain``."""

    def __post_init__(self) -> None:
        """``ValueError`` for parts that do not fit."""
        Law.__post_init__(self)
        bank = instance("bank", self.bank, FilterBank, "a FilterBank")
        H, s = bank.counts
        m = self.instruments.counts[1]
        depth = len(bank.voltage_input) // m - 1
        keep_matrices(self, {"state_gain": (H, m, s), "voltage_gain": (H, m, m * depth), "prior": (H,)})
        if self.transition is not None:
            keep_matrices(self, {"transition": (H, H)})
        object.__setattr__(self, "_motion", motion_of(bank, self.state_gain, self.transition is not None))
        object.__setattr__(self, "_log_prior", np.log(self.prior))
        object.__setattr__(self, "_before", np.ascontiguousarray(self.voltage_gain.swapaxes(1, 2)))

    @property
    def order(self) -> int:
        """Numbers in a blade's memory."""
        H, (p, m) = self.bank.counts[0], self.instruments.counts
        return self._motion.size + 2 * H + self._depth * m + p + self._own + 3

    @property
    def _depth(self) -> int:
        return self.voltage_gain.shape[-1] // self.voltage_gain.shape[-2]

    @property
    def _own(self) -> int:
        return 0 if self.fallback is None else self.fallback.order

    def recall(self, memory: Array) -> Memory:
        """What each number of a memory (N, order) is; predictions are a copy, as the filters' own states."""
        held = self._held(memory)
        return held._replace(predicted=self._motion.plain(held.predicted))

    def _held(self, memory: Array) -> Memory:
        """Views of a memory (N, order)."""
        H, (p, m), D, N = self.bank.counts[0], self.instruments.counts, self._depth, len(memory)
        parts: list[Array] = []
        first = 0
        for shape in ((self._motion.size,), (H,), (H,), (D, m), (p,), (self._own,), (), (), ()):
            following = first + prod(shape)
            parts.append(memory[:, first:following].reshape(N, *shape))
            first = following
        return Memory(*parts)

    def weights(self, memory: ArrayLike) -> Array:
        """(H,) or (N, H): how likely each hypothesis is, by a memory (order,) or (N, order) that ``predict`` gave."""
        rows = np.atleast_2d(np.asarray(memory, dtype=np.float64))
        weights = np.exp(self._log_prior + self._held(rows).evidence)
        return np.asarray(weights if np.ndim(memory) == 2 else weights[0])

    def misfits(self, memory: ArrayLike) -> Array:
        """(N,) of memories (N, order): mean normalised innovation squared per reading, about 1 where a model is right."""
        held = self._held(np.asarray(memory, dtype=np.float64))
        weights = np.exp(self._log_prior + held.evidence)
        return np.asarray(np.einsum("nh,nh->n", weights, held.squared) / np.maximum(held.readings, 1.0))

    def cautious(self, observation: Array, memory: Array) -> Array:
        """(N, m): the action that the fallback would ask for, whoever is in charge; ``ValueError`` without one."""
        if self.fallback is None:
            raise ValueError(f"{self.name} has no fallback.")
        own = self._held(memory).own
        return self.instruments.drive(self._of_fallback(self.fallback, own, self.instruments.read(observation)))

    def overruled(self, memory: Array, change: Array) -> Array:
        """The memory (N, order) that ``decide`` gave, once actions were applied that differ from its own by ``change`` (N, m)."""
        memory = memory.copy()
        held, m = self._held(memory), change.shape[1]
        volts = change * self.instruments.voltage_scale
        held.predicted[...] += self._motion.driven(np.pad(volts, ((0, 0), (0, self._depth * m))))
        if self._depth:
            held.voltages[:, 0] += volts
        if self.fallback is not None:
            held.own[...] += volts @ self.fallback.voltage_input.T
        return memory

    @np.errstate(over="ignore", invalid="ignore")
    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Correct, weigh, drive, mix, predict: all hypotheses and blades at once; of a reading that is no number comes none."""
        reading, rows = self.instruments.read(np.atleast_2d(observation)), np.atleast_2d(np.asarray(memory, dtype=np.float64))
        rows = rows if rows.strides[-1] == rows.itemsize else np.ascontiguousarray(rows)
        voltage, following = np.empty((len(rows), self.instruments.counts[1])), np.empty(rows.shape)
        N, order = rows.shape
        size = max(1, ceil(N / max(1, ceil(N * order / max(AT_ONCE, order)))))
        for first in range(0, len(rows), size):
            some = slice(first, first + size)
            voltage[some] = self._decided(reading[some], self._held(rows[some]), self._held(following[some]))
        action = self.instruments.drive(voltage)
        return (action, following) if observation.ndim == 2 else (action[0], following[0])

    def _decided(self, reading: Array, old: Memory, new: Memory) -> Array:
        """Voltages (N, m), V, from readings (N, p), A, and what was remembered; writes what is to be."""
        p = self.instruments.counts[0]
        seen = self._motion.seen(old.predicted)
        lost = self.bank.lost(reading, old.reading, old.instant == 0.0)
        self._compare(seen, reading)
        correction = self.bank.corrections(old.instant, seen[..., :p], lost)
        weights, new.evidence[...] = self._weighed(old.evidence + correction.log_density.T)
        self._judge(old, new, correction.squared.T, lost, weights)
        answers = self._motion.answers(old.instant, correction.whitened)
        answers += seen[..., p:]
        before = old.voltages.reshape(len(reading), -1)
        voltage = self._asked(answers, before, weights)
        if self.fallback is not None:
            voltage = self._in_charge(self.fallback, old, new, reading, voltage)
        voltages = np.concatenate([voltage, before], axis=1)
        if self.transition is None:
            self._motion.follow(old.instant, old.predicted, correction.whitened, voltages, new.predicted)
        else:
            self._motion.follow(old.instant, old.predicted, correction.whitened, np.zeros_like(voltages), new.predicted)
            self._mix(self.transition, weights, new)
            new.predicted[...] += self._motion.driven(voltages)
        new.voltages[...] = voltages[:, : before.shape[1]].reshape(new.voltages.shape)
        new.reading[...] = reading
        new.instant[...] = old.instant + 1.0
        return voltage

    def _compare(self, seen: Array, reading: Array) -> None:
        """Turns expected readings, as they will be taken, clipped, into innovations, and K x̂ into −K x̂, in place."""
        N, m = len(reading), self.instruments.counts[1]
        highest = np.tile(np.concatenate([self.bank.full_scale, np.full(m, np.inf)]), N)  # all in one row: short ones are slow
        rows = seen.reshape(len(seen), -1)
        np.minimum(rows, highest, out=rows)
        np.maximum(rows, -highest, out=rows)
        np.subtract(np.concatenate([reading, np.zeros((N, m))], axis=1).ravel(), rows, out=rows)

    def _weighed(self, evidence: Array) -> tuple[Array, Array]:
        """Weights (N, H), each at least the floor, which add up to 1, and the logarithm of each over that beforehand."""
        logarithm, floor = evidence + self._log_prior, max(self.floor, np.finfo(float).tiny)
        logarithm -= logarithm.max(axis=1, keepdims=True)
        weights = np.exp(logarithm)
        whole = weights.sum(axis=1, keepdims=True)
        weights /= whole
        np.maximum(weights, floor, out=weights)
        all_of_them = weights.sum(axis=1, keepdims=True)
        weights /= all_of_them
        logarithm -= np.log(whole)
        np.maximum(logarithm, np.log(floor), out=logarithm)
        logarithm -= np.log(all_of_them) + self._log_prior
        return weights, logarithm

    def _asked(self, answers: Array, before: Array, weights: Array) -> Array:
        """(N, m), V: the mean of what each regulator asks for, from its answer to its estimate, as the drive lets it through."""
        answers -= np.matmul(before, self._before)
        rows, limits = answers.reshape(len(answers), -1), np.tile(self.instruments.voltage_limits, len(before))
        np.minimum(np.maximum(rows, limits[0], out=rows), limits[1], out=rows)
        return np.asarray(np.matmul(weights[:, None], answers.swapaxes(0, 1))[:, 0])

    def _judge(self, old: Memory, new: Memory, squared: Array, lost: NDArray[np.bool_], weights: Array) -> None:
        """Whether any hypothesis fits; where none has, the fallback stays in charge for the rest of the episode."""
        fading = 1.0 - 1.0 / self.window
        new.squared[...] = fading * old.squared + squared
        new.readings[...] = fading * old.readings + np.count_nonzero(~lost, axis=1)
        misfit = np.einsum("nh,nh->n", weights, new.squared) > self.misfit * new.readings
        new.astray[...] = np.maximum(old.astray, misfit & (old.instant >= self.window))

    def _in_charge(self, fallback: LinearController, old: Memory, new: Memory, reading: Array, voltage: Array) -> Array:
        """(N, m), V: the fallback's voltages where it is in charge; it remembers what is applied whoever is."""
        voltage = np.where(new.astray[:, None] > 0.0, self._of_fallback(fallback, old.own, reading), voltage)
        new.own[...] = old.own @ fallback.transition.T + reading @ fallback.measurement_input.T + voltage @ fallback.voltage_input.T
        return voltage

    def _of_fallback(self, fallback: LinearController, own: Array, reading: Array) -> Array:
        """(N, m), V: what it asks for by its memory and readings (N, p), A, as the drive lets it through."""
        return self.instruments.limit(own @ fallback.state_gain.T + reading @ fallback.measurement_gain.T)

    def _mix(self, transition: Array, weights: Array, new: Memory) -> None:
        """Weights (N, H) and states of what may follow, moved on already: all move by the same matrix."""
        following = np.maximum(weights @ transition, np.finfo(float).tiny)  # where nothing leads, no share of anything is zero
        shares = weights[:, :, None] * transition / following[:, None, :]
        states = self._motion.by_hypothesis(new.predicted)
        states[...] = np.matmul(shares.swapaxes(1, 2), states)
        new.evidence[...] = np.log(following) - self._log_prior
