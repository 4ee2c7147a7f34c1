"""The law that weighs hypotheses by what is read: a filter and a regulator for each, and one voltage from all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import ceil, prod
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.design.controller import Array
from baselines.design.filter_bank import FilterBank
from baselines.design.law import Law
from baselines.design.linear import LinearController
from baselines.design.matrix import keep_matrices
from baselines.design.motion import Motion, in_single_precision, motion_of
from baselines.design.objects import instance

AT_ONCE = 2**20
"""Numbers of memories that are worked on at once: larger arrays in between would be asked of the system anew at every instant."""


Numbers = NDArray[np.floating[Any]]
Revision = Callable[[slice, Numbers, Numbers, Numbers, Numbers], Numbers]
"""Actions (N, m) in place of those that a law asks for, of the blades of a slice: from its own (N, m), its fallback's (N, m),
how badly any hypothesis fits (N,) as ``misfits`` has it, and how likely each is (N, H)."""


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
    single: bool = False
    """Whether it reckons and remembers in single precision, which takes less than half the time."""
    _bank: FilterBank = field(init=False)
    """As it reckons with it."""
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
        parts: dict[str, Any] = {
            "_bank": bank,
            "_motion": motion_of(bank, self.state_gain, self.transition is not None),
            "_log_prior": np.log(self.prior),
            "_before": np.ascontiguousarray(self.voltage_gain.swapaxes(1, 2)),
        }
        for name, part in parts.items():
            object.__setattr__(self, name, in_single_precision(part) if self.single else part)

    def in_single_precision(self) -> MultipleModel:
        """The same controller, reckoning in single precision: its voltages differ by some 1e-5 of the drive."""
        return self if self.single else replace(self, single=True)

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

    def overruled(self, memory: Any, change: Numbers) -> Any:
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

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Correct, weigh, drive, mix, predict: all hypotheses and blades at once; of a reading that is no number comes none."""
        rows = np.atleast_2d(memory)
        following = np.empty(rows.shape, self._log_prior.dtype)
        action = self.revised(np.atleast_2d(observation), rows, None, following)
        return (action, following) if observation.ndim == 2 else (action[0], following[0])

    @np.errstate(over="ignore", invalid="ignore")
    def revised(self, observation: Array, memory: Numbers, revise: Revision | None, following: Any) -> Array:
        """The actions (N, m) that are applied, ``revise``d ones if it is given, and writes the memory (N, order) that goes by them.

        ``ValueError`` for a controller to revise that has no fallback.
        """
        if revise is not None and self.fallback is None:
            raise ValueError(f"{self.name} has no fallback.")
        reading, rows = self.instruments.read(observation), np.asarray(memory, dtype=self._log_prior.dtype)
        rows = rows if rows.strides[-1] == rows.itemsize else np.ascontiguousarray(rows)
        voltage = np.empty((len(rows), self.instruments.counts[1]))
        N, order = rows.shape
        size = max(1, ceil(N / max(1, ceil(N * order / max(AT_ONCE, order)))))
        for first in range(0, len(rows), size):
            some = slice(first, first + size)
            voltage[some] = self._decided(reading[some], self._held(rows[some]), self._held(following[some]), revise, some)
        return self.instruments.drive(voltage)

    def _decided(self, reading: Array, old: Memory, new: Memory, revise: Revision | None, some: slice) -> Array:
        """Voltages (N, m), V, from readings (N, p), A, and what was remembered; writes what is to be."""
        p, reading = self.instruments.counts[0], reading.astype(old.reading.dtype)
        seen = self._motion.seen(old.predicted)
        lost = self._bank.lost(reading, old.reading, old.instant == 0.0)
        self._compare(seen, reading)
        correction = self._bank.corrections(old.instant, seen[..., :p], lost)
        weights, new.evidence[...] = self._weighed(old.evidence + correction.log_density.T)
        badly = self._judge(old, new, correction.squared.T, lost, weights)
        answers = self._motion.answers(old.instant, correction.whitened)
        answers += seen[..., p:]
        before = old.voltages.reshape(len(reading), -1)
        voltage = self._asked(answers, before, weights)
        if self.fallback is not None:
            cautious = self._of_fallback(self.fallback, old.own, reading)
            voltage = np.where(new.astray[:, None] > 0.0, cautious, voltage)
            if revise is not None:
                drive = self.instruments.drive
                voltage = revise(some, drive(voltage), drive(cautious), badly, weights) * self.instruments.voltage_scale
            self._remember(self.fallback, old, new, reading, voltage)
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
        none = np.zeros((N, m), reading.dtype)
        highest = np.tile(np.concatenate([self._bank.full_scale, none[0] + np.inf]), N)  # all in one row: short ones are slow
        rows = seen.reshape(len(seen), -1)
        np.minimum(rows, highest, out=rows)
        np.maximum(rows, -highest, out=rows)
        np.subtract(np.concatenate([reading, none], axis=1).ravel(), rows, out=rows)

    def _weighed(self, evidence: Array) -> tuple[Array, Array]:
        """Weights (N, H), each at least the floor, which add up to 1, and the logarithm of each over that beforehand."""
        logarithm, floor = evidence + self._log_prior, max(self.floor, float(np.finfo(evidence.dtype).tiny))
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
        limits = np.tile(self.instruments.voltage_limits.astype(answers.dtype), len(before))
        rows = answers.reshape(len(answers), -1)
        np.minimum(np.maximum(rows, limits[0], out=rows), limits[1], out=rows)
        return np.asarray(np.matmul(weights[:, None], answers.swapaxes(0, 1))[:, 0])

    def _judge(self, old: Memory, new: Memory, squared: Array, lost: NDArray[np.bool_], weights: Array) -> Array:
        """How badly any hypothesis fits (N,); where none has, the fallback stays in charge for the rest of the episode."""
        fading = 1.0 - 1.0 / self.window
        new.squared[...] = fading * old.squared + squared
        new.readings[...] = fading * old.readings + np.count_nonzero(~lost, axis=1)
        mean = np.einsum("nh,nh->n", weights, new.squared)
        new.astray[...] = np.maximum(old.astray, (mean > self.misfit * new.readings) & (old.instant >= self.window))
        return np.asarray(mean / np.maximum(new.readings, 1.0))

    def _remember(self, fallback: LinearController, old: Memory, new: Memory, reading: Array, voltage: Array) -> None:
        """The fallback remembers what is applied, whoever is in charge."""
        new.own[...] = old.own @ fallback.transition.T + reading @ fallback.measurement_input.T + voltage @ fallback.voltage_input.T

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
