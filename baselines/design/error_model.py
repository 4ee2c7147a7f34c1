"""The error of a reference model: what is seen of it in the readings, what observes it, and what undoes it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from baselines.design.controller import Array
from baselines.design.hidden_layer import Filtered
from baselines.design.matrix import keep_matrices, rows
from beamenv.configuration.read_only import ReadOnly


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ErrorModel(ReadOnly):
    """A reference model x̂⁺ = A (x̂ + L ε) + B u + D w with ε = y − C x̂, of n states, q forces w, m voltages and p sensors.

    Its error E = x − x̂ moves by E⁺ = Ā E + D (Δ − w) and what is random, Ā = A − A L C, ε = C E + v, Δ being the forces that act.
    """

    transition: Array
    """A (n, n)."""
    voltage_input: Array
    """B (n, m), per V."""
    output: Array
    """C (p, n), A."""
    force_input: Array
    """D (n, q): of forces in units of what is usual."""
    feedback_gain: Array
    """K (m, n), V."""
    kalman_gain: Array
    """L (n, p), per A."""
    observer_gain: Array
    """Λ (n, p), per A: that of the error observer, to which forces that nobody foresees are noise too."""
    whitening: Array
    """S^(−1/2) (p, p), per A, of the innovations' covariance S."""
    lyapunov: Array
    """P (n, n) = ĀᵀPĀ + CᵀS⁻¹C."""
    shown: Array
    """(n, 2 q): what a network is shown of a state, in units of what is usual, two numbers for each force."""
    full_scale: Array
    """(p,), A: the largest current that a reading can show."""
    drive: Array
    """(m,), V: the larger drive limit."""
    corrected: Array = field(init=False)
    """(L C)ᵀ (n, n)."""
    _felt: Array = field(init=False)
    _loop: Array = field(init=False)

    def __post_init__(self) -> None:
        """``ValueError`` for matrices that do not fit."""
        n, q, m, p = rows(self.transition), np.shape(self.force_input)[-1], len(self.drive), len(self.full_scale)
        shapes = {"transition": (n, n), "voltage_input": (n, m), "output": (p, n), "force_input": (n, q), "feedback_gain": (m, n)}
        shapes |= {"kalman_gain": (n, p), "observer_gain": (n, p), "whitening": (p, p), "lyapunov": (n, n), "shown": (n, 2 * q)}
        keep_matrices(self, {**shapes, "full_scale": (p,), "drive": (m,)})
        corrected = self.kalman_gain @ self.output
        object.__setattr__(self, "corrected", corrected.T)
        object.__setattr__(self, "_felt", (self.whitening @ self.output).T)
        object.__setattr__(self, "_loop", (self.transition - self.transition @ corrected).T)
        ReadOnly.__post_init__(self)

    @property
    def counts(self) -> tuple[int, int, int, int]:
        """States, forces, voltages and sensors."""
        return (*self.force_input.shape, len(self.drive), len(self.full_scale))

    def innovation(self, reading: Array, predicted: Array) -> Array:
        """ε (N, p), A, of readings (N, p), as they are taken, clipped at full scale."""
        return reading - np.clip(predicted @ self.output.T, -self.full_scale, self.full_scale)

    def design_innovation(self, innovation: Array, departure: Array) -> Array:
        """S^(−1/2) (ε + C δ) (N, p): what it would be, in units of what is usual, if no network had ever foreseen anything."""
        return innovation @ self.whitening.T + departure @ self._felt

    def observed_error(self, foreseen: Array, innovation: Array) -> Array:
        """Ê + Λ (ε − C Ê) (N, n)."""
        return foreseen + (innovation - foreseen @ self.output.T) @ self.observer_gain.T

    def energy(self, error: Array) -> Array:
        """ÊᵀPÊ (N,)."""
        return np.maximum(np.einsum("nk,nk->n", error @ self.lyapunov, error), 0.0)

    def network_inputs(self, estimate: Array) -> Array:
        """μ (N, q, 2) of states (N, n)."""
        return np.asarray((estimate @ self.shown).reshape(len(estimate), self.shown.shape[1] // 2, 2))

    def felt(self, units: Array, inputs: Array) -> Filtered:
        """What states (N, h, n) and (N, 2 q, n) that units and inputs brought about show in whitened innovations."""
        return Filtered(
            units @ self._felt, (inputs @ self._felt).reshape(len(inputs), inputs.shape[1] // 2, 2, self._felt.shape[1])
        )

    def moved(self, states: Array, forces: Array) -> Array:
        """Ā of states (N, k, n), which are brought about by ``forces`` (N, k) of one of the q each, in equal groups of k."""
        each = np.repeat(self.force_input.T, forces.shape[1] // self.force_input.shape[1], axis=0)
        return np.asarray(states @ self._loop + forces[..., None] * each)
