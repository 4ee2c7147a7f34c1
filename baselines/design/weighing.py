"""The law that weighs hypotheses by what is read: a filter and a regulator for each, and one voltage from all of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.design.controller import Array
from baselines.design.filter_bank import FilterBank
from baselines.design.law import Law
from baselines.design.linear import LinearController
from baselines.design.matrix import keep_matrices
from baselines.design.objects import instance

AT_ONCE = 2**18
"""Numbers of memories that are worked on at once: larger arrays in between would be asked of the system anew at every instant."""


class Memory(NamedTuple):
    """What is remembered of N blades, views of the rows of one array."""

    predicted: Array
    """(N, H, s)."""
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
    _moved: Array = field(init=False)
    """(H, s, p + m + s): [Cᵀ, −Kᵀ, Aᵀ], from a prediction to the readings, to what is asked for and to the next prediction."""
    _onward: Array = field(init=False)
    """(instants, H, p, m + s): C S [−Kᵀ, Aᵀ], the same of what readings add to it."""

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
        onward = np.concatenate([-self.state_gain.swapaxes(-1, -2), bank.transition], axis=-1)
        object.__setattr__(self, "_moved", np.concatenate([bank.output, onward], axis=-1))
        object.__setattr__(self, "_onward", np.matmul(bank.cross, onward))

    @property
    def order(self) -> int:
        """Numbers in a blade's memory."""
        H, s = self.bank.counts
        p, m = self.instruments.counts
        return H * (s + 2) + self._depth * m + p + self._own + 3

    @property
    def _depth(self) -> int:
        return self.voltage_gain.shape[-1] // self.voltage_gain.shape[-2]

    @property
    def _own(self) -> int:
        return 0 if self.fallback is None else self.fallback.order

    def recall(self, memory: Array) -> Memory:
        """What each number of a memory (N, order) is."""
        (H, s), (p, m), D, N = self.bank.counts, self.instruments.counts, self._depth, len(memory)
        ends = np.cumsum([H * s, H, H, D * m, p, self._own, 1, 1])
        parts = np.split(memory, ends, axis=1)
        shapes = ((N, H, s), (N, H), (N, H), (N, D, m), (N, p), (N, self._own), (N,), (N,), (N,))
        return Memory(*(part.reshape(shape) for part, shape in zip(parts, shapes, strict=True)))

    def weights(self, memory: ArrayLike) -> Array:
        """(H,) or (N, H): how likely each hypothesis is, by a memory (order,) or (N, order) that ``predict`` gave."""
        rows = np.atleast_2d(np.asarray(memory, dtype=np.float64))
        weights = np.exp(np.log(self.prior) + self.recall(rows).evidence)
        return np.asarray(weights if np.ndim(memory) == 2 else weights[0])

    def misfits(self, memory: ArrayLike) -> Array:
        """(N,) of memories (N, order): mean normalised innovation squared per reading, about 1 where a model is right."""
        recalled = self.recall(np.asarray(memory, dtype=np.float64))
        weights = np.exp(np.log(self.prior) + recalled.evidence)
        return np.asarray(np.einsum("nh,nh->n", weights, recalled.squared) / np.maximum(recalled.readings, 1.0))

    def cautious(self, observation: Array, memory: Array) -> Array:
        """(N, m): the action that the fallback would ask for, whoever is in charge; ``ValueError`` without one."""
        if self.fallback is None:
            raise ValueError(f"{self.name} has no fallback.")
        own = self.recall(memory).own
        asked = own @ self.fallback.state_gain.T + self.instruments.read(observation) @ self.fallback.measurement_gain.T
        return self.instruments.drive(self.instruments.limit(asked))

    def overruled(self, memory: Array, change: Array) -> Array:
        """The memory (N, order) that ``decide`` gave, once actions were applied that differ from its own by ``change`` (N, m)."""
        memory = memory.copy()
        held, m = self.recall(memory), change.shape[1]
        volts = change * self.instruments.voltage_scale
        held.predicted[...] += self.bank.driven(np.pad(volts, ((0, 0), (0, self._depth * m))))
        if self._depth:
            held.voltages[:, 0] += volts
        if self.fallback is not None:
            held.own[...] += volts @ self.fallback.voltage_input.T
        return memory

    @np.errstate(over="ignore", invalid="ignore")
    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Correct, weigh, drive, mix, predict: all hypotheses and blades at once; of a reading that is no number comes none."""
        reading, rows = self.instruments.read(np.atleast_2d(observation)), np.atleast_2d(memory)
        voltage, following = np.empty((len(rows), self.instruments.counts[1])), np.empty(rows.shape)
        size = max(1, AT_ONCE // rows.shape[1])
        for first in range(0, len(rows), size):
            some = slice(first, first + size)
            voltage[some] = self._decided(reading[some], self.recall(rows[some]), self.recall(following[some]))
        action = self.instruments.drive(voltage)
        return (action, following) if observation.ndim == 2 else (action[0], following[0])

    def _decided(self, reading: Array, old: Memory, new: Memory) -> Array:
        """Voltages (N, m), V, from readings (N, p), A, and what was remembered; writes what is to be."""
        p, m = self.instruments.counts
        moved = self._from(old.predicted.swapaxes(0, 1))
        lost = self.bank.lost(reading, old.reading, old.instant == 0.0)
        correction = self.bank.corrections(old.instant, moved[..., :p], reading, lost)
        weights = self._weights(old.evidence + correction.log_density.T)
        self._judge(old, new, correction.squared.T, lost, weights)
        carried = self.bank.carried(old.instant, correction.whitened, self._onward)
        moved = np.add(moved[..., p:], carried, out=carried)
        before = old.voltages.reshape(len(reading), -1)
        voltage = self._asked(moved[..., :m], before, weights)
        if self.fallback is not None:
            voltage = self._in_charge(self.fallback, old, new, reading, voltage)
        estimate = moved[..., m:].swapaxes(0, 1)
        if self.transition is not None:
            weights, estimate = self._mixed(self.transition, weights, estimate)
        voltages = np.concatenate([voltage, before], axis=1)
        np.add(estimate, self.bank.driven(voltages), out=new.predicted)
        new.evidence[...] = np.log(weights) - np.log(self.prior)
        new.voltages[...] = voltages[:, : before.shape[1]].reshape(new.voltages.shape)
        new.reading[...] = reading
        new.instant[...] = old.instant + 1.0
        return voltage

    def _from(self, predicted: Array) -> Array:
        """(H, N, p + m + s) of predictions (H, N, s), shorter ones by what is theirs."""
        (H, N, s), more = predicted.shape, sum(self.instruments.counts)
        moved = np.empty((H, N, more + s))
        for those, size in self.bank.alike:
            out = moved[those, :, : more + size]
            np.matmul(predicted[those, :, :size], self._moved[those, :size, : more + size], out=out)
            moved[those, :, more + size :] = 0.0
        return moved

    def _weights(self, evidence: Array) -> Array:
        """(N, H), each at least the floor, which add up to 1."""
        logarithm = np.log(self.prior) + evidence
        weights = np.exp(logarithm - logarithm.max(axis=1, keepdims=True))
        weights /= weights.sum(axis=1, keepdims=True)
        weights = np.maximum(weights, max(self.floor, np.finfo(float).tiny))
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))

    def _asked(self, answers: Array, before: Array, weights: Array) -> Array:
        """(N, m), V: the mean of what each regulator asks for, from its answer to its estimate, as the drive lets it through."""
        asked = answers - np.matmul(before, self.voltage_gain.swapaxes(-1, -2))
        return np.asarray(np.einsum("nh,hnm->nm", weights, self.instruments.limit(asked)))

    def _judge(self, old: Memory, new: Memory, squared: Array, lost: NDArray[np.bool_], weights: Array) -> None:
        """Whether any hypothesis fits; where none has, the fallback stays in charge for the rest of the episode."""
        fading = 1.0 - 1.0 / self.window
        new.squared[...] = fading * old.squared + squared
        new.readings[...] = fading * old.readings + np.count_nonzero(~lost, axis=1)
        misfit = np.einsum("nh,nh->n", weights, new.squared) > self.misfit * new.readings
        new.astray[...] = np.maximum(old.astray, misfit & (old.instant >= self.window))

    def _in_charge(self, fallback: LinearController, old: Memory, new: Memory, reading: Array, voltage: Array) -> Array:
        """(N, m), V: the fallback's voltages where it is in charge; it remembers what is applied whoever is."""
        own = self.instruments.limit(old.own @ fallback.state_gain.T + reading @ fallback.measurement_gain.T)
        voltage = np.where(new.astray[:, None] > 0.0, own, voltage)
        new.own[...] = old.own @ fallback.transition.T + reading @ fallback.measurement_input.T + voltage @ fallback.voltage_input.T
        return voltage

    @staticmethod
    def _mixed(transition: Array, weights: Array, estimate: Array) -> tuple[Array, Array]:
        """Weights (N, H) and estimates (N, H, s) of what may follow, moved on already: all move by the same matrix."""
        following = weights @ transition
        shares = weights[:, :, None] * transition / following[:, None, :]
        return following, np.matmul(shares.swapaxes(1, 2), estimate)
