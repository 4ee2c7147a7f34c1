"""The error of a reference model: what is seen of it in the readings, what observes it, and what undoes it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from baselines.design.controller import Array
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
    lyapunov: Array
    """P (n, n) = ĀᵀPĀ + Q."""
    direction: Array
    """(n, q): p = Ê @ direction, in which outputs lessen EᵀPE."""
    full_scale: Array
    """(p,), A: the largest current that a reading can show."""
    drive: Array
    """(m,), V: the larger drive limit."""
    usual: Array
    """(n,): root mean square of each state of the design in its closed loop; 0 where the network is not shown it."""
    lags: int
    """How many of the latest voltages the network is shown."""
    corrected: Array = field(init=False)
    """L C (n, n)."""
    _shown: Array = field(init=False)

    def __post_init__(self) -> None:
        """``ValueError`` for matrices that do not fit."""
        n, q, m, p = rows(self.transition), np.shape(self.force_input)[-1], len(self.drive), len(self.full_scale)
        shapes = {"transition": (n, n), "voltage_input": (n, m), "output": (p, n), "force_input": (n, q), "feedback_gain": (m, n)}
        shapes |= {"kalman_gain": (n, p), "observer_gain": (n, p), "lyapunov": (n, n), "direction": (n, q)}
        keep_matrices(self, {**shapes, "full_scale": (p,), "drive": (m,), "usual": (n,)})
        shown = np.flatnonzero(self.usual)
        object.__setattr__(self, "corrected", self.kalman_gain @ self.output)
        object.__setattr__(self, "_shown", np.eye(n)[:, shown] / self.usual[shown])
        ReadOnly.__post_init__(self)

    @property
    def inputs(self) -> int:
        """f: how many numbers the network is shown."""
        return 1 + self._shown.shape[1] + self.lags * len(self.drive)

    def innovation(self, reading: Array, predicted: Array) -> Array:
        """ε (N, p), A, of readings (N, p), as they are taken, clipped at full scale."""
        return reading - np.clip(predicted @ self.output.T, -self.full_scale, self.full_scale)

    def observed_error(self, foreseen: Array, innovation: Array) -> Array:
        """Ê + Λ (ε − C Ê) (N, n)."""
        return foreseen + (innovation - foreseen @ self.output.T) @ self.observer_gain.T

    def energy(self, error: Array) -> Array:
        """ÊᵀPÊ (N,)."""
        return np.einsum("nk,nk->n", error @ self.lyapunov, error)

    def network_inputs(self, estimate: Array, voltage: Array, before: Array) -> Array:
        """μ (N, f): a one, the estimate (N, n), the voltages (N, m), V, and those shown ``before``, newest first."""
        first = 1 + self._shown.shape[1]
        older = before[:, first : before.shape[1] - voltage.shape[1]] if self.lags else before[:, first:]
        latest = [voltage / self.drive, older] if self.lags else []
        return np.hstack([np.ones((len(estimate), 1)), estimate @ self._shown, *latest])
