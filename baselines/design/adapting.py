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
from baselines.design.hidden_layer import Learning, Weights, hidden_units, learned, norms, outputs
from baselines.design.law import Law
from baselines.design.linear import LinearController
from baselines.design.matrix import keep_matrices, real_matrix
from baselines.design.objects import instance

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
    inputs: Array
    """μ (N, f): what the network was shown last."""
    units: Array
    """σ (N, h): its hidden units then."""
    outer: Array
    """W (N, h, q)."""
    inner: Array
    """V − V₀ (N, f, h)."""
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
    """A linear law less an adaptive voltage, for one blade or a batch; every blade has a network of its own.

    The network foresees the forces w that act and are not in the design, and what it foresees goes through the design's filter and
    regulator. With x̂ the state of the reference model, the design in a loop with the readings,

        ε = y − C x̂,            x̂ ← x̂ + L ε,         x̂⁺ = A x̂ + B u + D w,         w = Wᵀ σ(Vᵀ μ),
        δ ← δ − L C δ,          u_ad = K δ,           u = clip(M ξ + T y − u_ad),    δ⁺ = A δ + D w,
        Ê ← Ê + Λ (ε − C Ê),    p ∝ Dᵀ P Ê,           Ê⁺ = A (Ê − L ε),

    u_ad within its share of the drive, μ a one, the estimate and the latest voltages in units of what is usual. W and V learn along
    p (``hidden_layer.learned``), P = ĀᵀPĀ + CᵀS⁻¹C, Ā = A − ALC: EᵀPE is what the error E of the model will show in normalised
    innovations squared. Where ε is white, as on the design, p has no direction in the mean and nothing is learned but noise. δ is
    the answer of a stable filter to a network whose weights are bounded, so that u_ad is bounded whatever the blade does.
    """

    base: LinearController
    """M, T, F, G, H; it stands behind the same instruments."""
    model: ErrorModel
    """A, B, C, D, K, L, Λ and P."""
    start: Array
    """V₀ (f, h)."""
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
        keep_matrices(self, {"start": (self.model.inputs, np.shape(self.start)[-1])})

    @property
    def order(self) -> int:
        """Numbers in a blade's memory."""
        return sum(map(prod, self._shapes))

    @property
    def _shapes(self) -> tuple[tuple[int, ...], ...]:
        (n, q), (f, h), m = self.model.force_input.shape, self.start.shape, self.instruments.counts[1]
        return (self.base.order,), (n,), (n,), (n,), (f,), (h,), (h, q), (f, h), (), (m,)

    def switched(self, on: bool) -> AdaptiveNeural:
        """The same law with its adaptation on or off; either goes on from what the other remembers, without a jump."""
        return self if on is self.adapts else replace(self, adapts=on)

    def in_physical_units(self) -> AdaptiveNeural:
        """The same law taking amperes and giving volts; so does its base."""
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
        model = self.model
        innovation = model.innovation(self.instruments.read(observation), old.predicted)
        error = model.observed_error(old.error, innovation)
        new.energy[...] = model.energy(error)
        weights = self._learned(old, error, new.energy)
        new.outer[...], new.inner[...] = weights
        estimate = old.predicted + innovation @ model.kalman_gain.T
        departure = old.departure - old.departure @ model.corrected.T
        new.adaptive[...] = np.clip(departure @ model.feedback_gain.T, -self.authority * model.drive, self.authority * model.drive)
        action = self._driven(observation, old, new)
        voltage = action * self.instruments.voltage_scale
        new.inputs[...] = model.network_inputs(estimate, voltage, old.inputs)
        new.units[...] = hidden_units(self.start, weights, new.inputs)
        forces = outputs(weights, new.units) @ model.force_input.T
        new.predicted[...] = estimate @ model.transition.T + voltage @ model.voltage_input.T + forces
        new.departure[...] = departure @ model.transition.T + forces
        new.error[...] = (error - innovation @ model.kalman_gain.T) @ model.transition.T
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

    def _learned(self, old: Memory, error: Array, energy: Array) -> Weights:
        """The weights after this reading."""
        if not self.adapts:
            return Weights((1.0 - FADES) * old.outer, (1.0 - FADES) * old.inner)
        direction = error @ self.model.direction
        return learned(Weights(old.outer, old.inner), old.inputs, old.units, direction, np.sqrt(energy), self.learning)
