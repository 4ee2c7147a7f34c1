"""From innovations to what a plant has: white loads on its states, and noise of its sensors that nothing else knows of.

An innovation model has one noise, e, on readings and states alike. A ``Plant`` has two that are independent. Sought are inputs E
(n, k) of k white loads of unit variance, held over each interval, and variances V of the sensors' noise with the same spectrum of
readings, as Whittle's likelihood measures it:

    Φ(ω) = C (zI − A)⁻¹ E Eᵀ (…)ᴴ Cᵀ + V    against    H Λ Hᴴ,   H = I + C (zI − A)⁻¹ K

As many loads are taken as the likelihood pays for (Schwarz's criterion).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from baselines.identification.innovation_model import InnovationModel
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

LOWEST = 0.005
"""rad per row, the lowest frequency compared; the half circle has π."""
FREQUENCIES = 400
STEPS = 300
DISTINCT = 1e-4
"""Loss of likelihood a row below which two spectra count as one."""


@dataclass(frozen=True, slots=True, eq=False)
class WhiteNoise(ReadOnly):
    """White loads and sensor noise of a sampled model."""

    load_input: Array
    """E (n, k): states by loads of unit variance."""
    sensor_variance: Array
    """V (p,): of one reading's noise, in its unit squared."""
    loss: float
    """Likelihood a row that the two independent noises lose against the innovations."""


def white_noise(model: InnovationModel, rows: int) -> WhiteNoise:
    """The noise of a model that was identified from so many rows."""
    spectrum = _Spectrum(model)
    best = spectrum.fitted(1, None)
    for loads in range(2, len(model.C) + 1):
        if best.loss < DISTINCT:
            break
        more = spectrum.fitted(loads, best)
        if rows * (best.loss - more.loss) < 0.5 * model.order * np.log(rows):
            break
        best = more
    return best


class _Spectrum:
    """What readings of unit innovations have, on a grid of frequencies, and how far two noises are from it."""

    def __init__(self, model: InnovationModel) -> None:
        self.model = model
        self.scale = np.sqrt(np.diag(model.covariance))
        angles = np.geomspace(LOWEST, np.pi, FREQUENCIES)
        weights = np.gradient(angles)
        self.weights = weights / weights.sum()
        z = np.exp(1j * angles)[:, None, None]
        resolved = np.linalg.inv(z * np.eye(model.order) - model.A)
        self.seen = (model.C / self.scale[:, None]) @ resolved
        innovations = np.eye(len(model.C)) + self.seen @ (model.K * self.scale)
        correlation = model.covariance / np.outer(self.scale, self.scale)
        self.wanted = innovations @ correlation @ innovations.conj().swapaxes(1, 2)
        self.least = float(self.weights @ (np.linalg.slogdet(self.wanted)[1] + len(model.C)))

    def fitted(self, loads: int, before: WhiteNoise | None) -> WhiteNoise:
        """The least loss with so many loads, one of them new beside those found ``before``."""
        n, p = self.model.order, len(self.model.C)
        directions, sizes, _ = np.linalg.svd(self.model.K * self.scale, full_matrices=False)
        begun = (directions * sizes)[:, :loads]
        if before is not None:
            begun = np.hstack([before.load_input, 0.1 * begun[:, -1:]])
        variance = np.full(p, 0.5) if before is None else before.sensor_variance / self.scale**2
        start = np.concatenate([begun.ravel(), np.log(variance)])
        options = {"maxiter": STEPS, "maxfun": 2 * STEPS}
        found = minimize(self._loss, start, args=(n, loads), jac=True, method="L-BFGS-B", options=options)
        E, V = found.x[: n * loads].reshape(n, loads), np.exp(found.x[n * loads :])
        return WhiteNoise(E, V * self.scale**2, 0.5 * (float(found.fun) - self.least))

    def _loss(self, numbers: Array, n: int, loads: int) -> tuple[float, Array]:
        """Σ log det Φ + tr Φ⁻¹ S over the frequencies, and its gradient."""
        E, V = numbers[: n * loads].reshape(n, loads), np.exp(numbers[n * loads :])
        shown = self.seen @ E
        inverse = np.linalg.inv(shown @ shown.conj().swapaxes(1, 2) + np.diag(V))
        inside = inverse @ self.wanted
        value = self.weights @ (np.trace(inside, axis1=1, axis2=2).real - np.linalg.slogdet(inverse)[1])
        pull = (inverse - inside @ inverse) * self.weights[:, None, None]
        of_loads = 2.0 * np.tensordot(self.seen.conj(), pull @ shown, ((0, 1), (0, 1))).real
        of_noise = np.einsum("fpp->p", pull.real) * V
        return float(value), np.concatenate([of_loads.ravel(), of_noise])
