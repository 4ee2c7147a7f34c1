"""Adaptive output feedback by a neural network that augments an LQG: it learns what moves the blade and is not in the design.

Calise, Hovakimyan and Idan, Automatica 37, 2001; Hovakimyan, Nardi, Calise and Kim, IEEE Trans. Neural Networks 13, 2002; with the
reference model in a loop of its own, for very flexible structures, Qu and Annaswamy, J. Guidance, Control, and Dynamics 39, 2016.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import prod
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.controller import Array
from baselines.design.error_model import ErrorModel
from baselines.design.hidden_layer import Learning, Weights, hidden_units, learned, norms, outputs, prediction_error
from baselines.design.law import Law
from baselines.design.linear import LinearController
from baselines.design.matrix import keep_matrices, real_matrix, rows
from baselines.design.objects import instance
from beamenv.configuration import Flag, checked

FADES = 0.05
"""Share of its weights that the network forgets at each instant once it is switched off: within 20 instants the voltage is the
base's, without a jump."""


class Memory(NamedTuple):
    """What is remembered of N blades, views of the rows of one array."""

    own: Array
    """ξ (N, s): the base law's."""
    predicted: Array
    """x̂ (N, n): the state as the adapted model foresees it."""
    departure: Array
    """δ (N, n): the part of it that is the network's doing."""
    error: Array
    """Ê (N, n): the error that is still in it, as the error observer has it."""
    by_units: Array
    """(N, h, n): the states that each hidden unit would have brought about with a weight of 1."""
    by_inputs: Array
    """(N, 2 q, n): those that each input would have brought about."""
    units: Array
    """σ (N, h): hidden units."""
    outer: Array
    """W (N, h)."""
    inner: Array
    """V − V₀ (N, h, 2)."""
    bias: Array
    """b (N, p): of whitened innovations."""
    energy: Array
    """ÊᵀPÊ (N,)."""
    adaptive: Array
    """u_ad (N, m), V."""


class Adaptation(NamedTuple):
    """How an adaptation stands, of one blade or of N."""

    error_energy: Array
    """ÊᵀPÊ (N,): normalised innovations squared that the present error would still cause."""
    outer_norm: Array
    """‖W‖ (N,)."""
    inner_norm: Array
    """‖V − V₀‖ (N,)."""
    effort: Array
    """(N,): the largest adaptive voltage over the drive limit."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AdaptiveNeural(Law):
    """A linear controller less an adaptive voltage, for one blade or a batch; every blade has a network of its own.

    The network foresees the forces w that act and are not in the design, and what it foresees goes through the design's filter and
    regulator. With x̂ the state of the reference model, the design in a loop with the readings,

        ε = y − C x̂,          x̂ ← x̂ + L ε,         x̂⁺ = A x̂ + B u + D w,         w = Wᵀ σ(Vᵀ μ),
        δ ← δ − L C δ,        u_ad = K δ,           u = clip(M ξ + T y − u_ad),    δ⁺ = A δ + D w,

    u_ad within its share of the drive; μ are the deflection and the velocity of each mode in x̂ in units of what is usual. W and V
    learn from ε + C δ, the innovations of the design alone, and from what the units and inputs would have made of them through the
    same filter (``hidden_layer.learned``): on the design they are white, and nothing is learned but noise. An error observer,
    Ê ← Ê + Λ (ε − C Ê), tells the energy EᵀPE of the model's error, P = ĀᵀPĀ + CᵀS⁻¹C with Ā = A − ALC: the normalised innovations
    squared that it will cause. δ is the answer of a stable filter to a network whose weights are bounded, so that u_ad is bounded
    whatever the blade does.
    """

    base: LinearController
    """M, T, F, G, H; it stands behind the same instruments."""
    model: ErrorModel
    """A, B, C, D, K, L, Λ, S and P."""
    start: Array
    """V₀ (h, 2)."""
    learning: Learning
    authority: float
    """Largest adaptive voltage over the drive limit."""
    adapts: bool = True
    """Off, the network unlearns what it has learned, and the voltage is the base's."""

    def __post_init__(self) -> None:
        """``ValueError`` for what is no linear law and for weights that do not fit."""
        Law.__post_init__(self)
        instance("base", self.base, LinearController, "a LinearController, such as reference_lqg(plant)")
        instance("model", self.model, ErrorModel, "an ErrorModel, such as error_model(plant, base)")
        keep_matrices(self, {"start": (rows(self.start), 2)})

    @property
    def order(self) -> int:
        """Numbers in a blade's memory."""
        return sum(map(prod, self._shapes))

    @property
    def _shapes(self) -> tuple[tuple[int, ...], ...]:
        (n, q, m, p), h = self.model.counts, len(self.start)
        return (self.base.order,), (n,), (n,), (n,), (h, n), (2 * q, n), (h,), (h,), (h, 2), (p,), (), (m,)

    def switched(self, on: bool) -> AdaptiveNeural:
        """The same controller with its adaptation on or off; either goes on from what the other remembers, without a jump.

        Raises ``ValueError`` for what is neither True nor False.
        """
        on = checked("on", on, Flag())
        return self if on is self.adapts else replace(self, adapts=on)

    def in_physical_units(self) -> AdaptiveNeural:
        """The same controller taking amperes and giving volts; so does its base."""
        return replace(self, instruments=self.instruments.in_physical_units(), base=self.base.in_physical_units())

    def recall(self, memory: Array) -> Memory:
        """What each number of a memory (N, order) is."""
        parts: list[Array] = []
        first = 0
        for shape in self._shapes:
            following = first + prod(shape)
            parts.append(memory[:, first:following].reshape(len(memory), *shape))
            first = following
        return Memory(*parts)

    def adaptation(self, memory: ArrayLike) -> Adaptation:
        """How far it is, by a memory (order,) or (N, order) that ``predict`` gave; ``ValueError`` for any other."""
        given = np.shape(memory)
        rows = real_matrix("memory", memory, (*given[:-1], self.order) if len(given) in (1, 2) else (self.order,))
        held = self.recall(np.atleast_2d(rows))
        effort = np.abs(held.adaptive / self.model.drive).max(axis=1)
        found = Adaptation(held.energy, norms(held.outer), norms(held.inner), effort)
        return found if rows.ndim == 2 else Adaptation(*(each[0] for each in found))

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Learn from the reading, correct, drive, foresee."""
        rows, seen = np.atleast_2d(memory), np.atleast_2d(observation)
        following = np.empty_like(rows)
        action = self._decided(seen, self.recall(rows), self.recall(following))
        return (action, following) if observation.ndim == 2 else (action[0], following[0])

    def _decided(self, observation: Array, old: Memory, new: Memory) -> Array:
        """Actions (N, m); writes what is to be remembered."""
        model, gain = self.model, self.model.kalman_gain
        innovation = model.innovation(self.instruments.read(observation), old.predicted)
        error = model.observed_error(old.error, innovation)
        new.energy[...] = model.energy(error)
        weights = self._learned(old, innovation, new.energy)
        new.outer[...], new.inner[...], new.bias[...] = weights
        estimate, departure = old.predicted + innovation @ gain.T, old.departure - old.departure @ model.corrected
        most = self.authority * model.drive
        new.adaptive[...] = np.clip(departure @ model.feedback_gain.T, -most, most)
        action = self._driven(observation, old, new)
        inputs = model.network_inputs(estimate)
        new.units[...] = hidden_units(self.start, weights, inputs, self.learning.saturation)
        forces = outputs(weights, new.units, inputs.shape[1]) @ model.force_input.T
        driven = (action * self.instruments.voltage_scale) @ model.voltage_input.T
        new.predicted[...] = estimate @ model.transition.T + driven + forces
        new.departure[...] = departure @ model.transition.T + forces
        new.error[...] = (error - innovation @ gain.T) @ model.transition.T
        new.by_units[...] = model.moved(old.by_units, new.units)
        new.by_inputs[...] = model.moved(old.by_inputs, inputs.reshape(len(inputs), old.by_inputs.shape[1]))
        return action

    def _driven(self, observation: Array, old: Memory, new: Memory) -> Array:
        """What the base asks for less the adaptive voltage; the base's memory goes by what is applied."""
        (fused, feedback), order = self.base.matrices, self.base.order
        product = np.concatenate([old.own, observation], axis=-1) @ fused
        limits = self.instruments.drive(self.instruments.voltage_limits)
        asked = product[:, order:] - self.instruments.drive(new.adaptive)
        action = np.minimum(np.maximum(asked, limits[0]), limits[1])
        new.own[...] = product[:, :order] + action @ feedback
        return action

    def _learned(self, old: Memory, innovation: Array, energy: Array) -> Weights:
        """The weights after this reading."""
        weights = Weights(old.outer, old.inner, old.bias)
        if not self.adapts:
            return Weights(*((1.0 - FADES) * each for each in weights))
        felt = self.model.felt(old.by_units, old.by_inputs)
        error = prediction_error(weights, felt, self.model.design_innovation(innovation, old.departure))
        return learned(weights, felt, old.units, error, np.sqrt(energy), self.learning)
