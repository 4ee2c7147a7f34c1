"""Prediction error: the model whose one-step errors are least, by Gauss and Newton over frequencies.

With the spectra U, Y of a record of N rows, Δ(z) = (zI − A + K C)⁻¹ and the states' own X = Δ (B U + K Y + z ξ/√N), the errors are
ε = Y − C X, exactly: ξ = x_0 − x_N closes the record to a circle, and is estimated beside the model. Minimised is log det of the
errors' covariance Λ, which of Gaussian noise is the likelihood (Ljung 1999, §7.4; in frequencies, McKelvey, Automatica 38, 2002).

The derivatives need no more than Δ and X:

    −∂ε = C Δ (∂A X + ∂B U + ∂K ε + ∂ξ z/√N) + (I − C Δ K) ∂C X

A's parameters are logarithms of the poles. Each mode's states may be turned and scaled, each real pole's scaled, and nothing that
is seen changes: such directions have no curvature, and no step is taken along them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from baselines.identification.innovation_model import LEAST_POLE, InnovationModel
from baselines.identification.measurement import Measurement
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Progress = Callable[[float], None]

AT_ONCE = 2000
"""Frequencies whose derivatives are held in memory together."""
CURVATURE_LINES = 6000
"""Frequencies that the curvature is summed over, drawn from all: the gradient has them all, so the minimum is the same one."""
ENOUGH = 0.02
"""Gain in log det Λ below which no further step is taken, over k/N, which k parameters win from the noise of N rows."""
FLAT = 1e-7
"""Curvature over the largest, parameters scaled to one, below which a direction counts as without any."""

FARTHEST = 10.0
"""Growth of a pole's logarithm in one step, at most: what goes so far is unstable and no number overflows."""


@dataclass(frozen=True, slots=True, eq=False)
class Refined(ReadOnly):
    """A model at the least prediction error, and how well its parameters are known."""

    model: InnovationModel
    start: Array
    """ξ (n,): x_0 − x_N."""
    log_det: float
    """Of Λ, in the units of the record."""
    parameters: Array
    """Covariance of the parameters, as ``moved`` takes steps (k, k), by Cramér and Rao; none along what nothing seen tells."""


class Spectra:
    """A record's discrete Fourier transform over √N at the positive frequencies."""

    def __init__(self, measured: Measurement) -> None:
        self.rows, self.interval = len(measured), measured.interval
        voltages, readings = (each - each.mean(axis=0) for each in (measured.voltages, measured.readings))
        self.U, self.Y = (np.fft.rfft(each, axis=0)[1:] / np.sqrt(self.rows) for each in (voltages, readings))
        self.z = np.exp(2j * np.pi * np.arange(1, len(self.U) + 1) / self.rows)

    def __len__(self) -> int:
        return len(self.z)


class _Errors:
    """What a model makes of some frequencies: F of them."""

    def __init__(self, spectra: Spectra, model: InnovationModel, start: Array, chosen: slice | NDArray[np.int64]) -> None:
        z, U, Y = spectra.z[chosen], spectra.U[chosen], spectra.Y[chosen]
        ends = z[:, None] / np.sqrt(spectra.rows)
        eigenvalues, vectors = np.linalg.eig(model.predictor)
        inputs = np.hstack([model.B, model.K, start[:, None]])
        across = np.linalg.solve(vectors, np.hstack([inputs, np.eye(model.order)]).astype(complex))
        resolved = 1.0 / (z[:, None] - eigenvalues)
        X = (resolved * (np.hstack([U, Y, ends]) @ across[:, : inputs.shape[1]].T)) @ vectors.T
        self.states, self.errors = X, Y - X @ model.C.T
        self.driving = np.hstack([U, self.errors, ends])
        self._resolved, self._left, self._right = resolved, model.C @ vectors, across[:, inputs.shape[1] :]

    def sensitivity(self, whitener: Array) -> Complex:
        """Λ^{−½} C Δ (F, p, n)."""
        return np.asarray(((whitener @ self._left) * self._resolved[:, None, :]) @ self._right)

    def adjoint(self, whitener: Array, white: Complex) -> Complex:
        """Its adjoint on whitened errors (F, p): (F, n)."""
        return np.asarray((white @ (whitener @ self._left).conj() * self._resolved.conj()) @ self._right.conj())


def _covariance(spectra: Spectra, model: InnovationModel, start: Array) -> Array:
    """Λ (p, p)."""
    total = np.zeros((len(model.C),) * 2)
    for some in _chunks(len(spectra), 4 * AT_ONCE):
        errors = _Errors(spectra, model, start, some).errors
        total += (errors.conj().T @ errors).real
    return np.asarray(total / len(spectra))


def _chunks(count: int, size: int) -> Iterator[slice]:
    return (slice(first, min(first + size, count)) for first in range(0, count, size))


def refined(
    spectra: Spectra,
    model: InnovationModel,
    start: Array | None = None,
    *,
    steps: int = 12,
    enough: float = ENOUGH,
    lines: int = CURVATURE_LINES,
    progress: Progress | None = None,
) -> Refined:
    """The least prediction error near ``model``, after at most so many steps of Levenberg's and Marquardt's."""
    start, damping = np.zeros(model.order) if start is None else start, 1e-5
    covariance = _covariance(spectra, model, start)
    least = _log_det(covariance)
    curvature, gradient = _normal_equations(spectra, model, start, covariance, lines)
    for step in range(steps):
        found = _improved(spectra, model, start, least, (curvature, gradient), damping)
        if found is None:
            break
        gain, (model, start, covariance, damping) = least - _log_det(found[2]), found
        least -= gain
        curvature, gradient = _normal_equations(spectra, model, start, covariance, lines)
        if progress:
            progress((step + 1) / steps)
        if gain < enough * len(gradient) / spectra.rows:
            break
    return Refined(replace(model, covariance=covariance), start, least, _inverse(2.0 * curvature))


def _log_det(covariance: Array) -> float:
    sign, value = np.linalg.slogdet(covariance)
    return float(value) if sign > 0 and np.isfinite(value) else np.inf


def _improved(
    spectra: Spectra,
    model: InnovationModel,
    start: Array,
    least: float,
    equations: tuple[Array, Array],
    damping: float,
) -> tuple[InnovationModel, Array, Array, float] | None:
    """A better model, its ends, Λ and the damping to go on with; None where even small steps make nothing better."""
    curvature, gradient = equations
    scale, values, vectors = _scaled_directions(curvature)
    along = vectors.T @ (gradient / scale)
    for _ in range(8):
        step = vectors @ (along / (np.maximum(values, 0.0) + damping)) / scale
        tried, ends = moved(model, step), start + _ends(step, model)
        if tried.stable:
            covariance = _covariance(spectra, tried, ends)
            if _log_det(covariance) < least:
                return tried, ends, covariance, max(0.1 * damping, 1e-8)
        damping *= 10.0
    return None


def _scaled_directions(matrix: Array) -> tuple[Array, Array, Array]:
    """Scales (k,) that make its diagonal one, and eigenvalues and directions of what it then is."""
    diagonal = np.diag(matrix)
    scale = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    values, vectors = np.linalg.eigh(matrix / np.outer(scale, scale))
    return scale, values, vectors


def _inverse(information: Array) -> Array:
    """Of a matrix without curvature in some directions, nothing along these."""
    scale, values, vectors = _scaled_directions(information)
    known = values > FLAT * values[-1]
    return np.asarray((vectors[:, known] / values[known]) @ vectors[:, known].T / np.outer(scale, scale))


def moved(model: InnovationModel, step: Array) -> InnovationModel:
    """The model after a step (k,) of its parameters: Re and Im of log λ/Δt of each mode, then log λ/Δt of each real pole, B, K and
    ξ row by row, C.
    """
    (n, m), p, r, s = model.B.shape, len(model.C), len(model.pairs), len(model.reals)
    along = step[: 2 * r].reshape(r, 2) * model.interval
    driving = step[n : n + n * (m + p + 1)].reshape(n, m + p + 1)
    return replace(
        model,
        pairs=model.pairs * np.exp(np.minimum(along[:, 0], FARTHEST) + 1j * along[:, 1]),
        reals=np.maximum(model.reals * np.exp(np.minimum(step[2 * r : 2 * r + s] * model.interval, FARTHEST)), LEAST_POLE),
        B=model.B + driving[:, :m],
        K=model.K + driving[:, m : m + p],
        C=model.C + step[n + n * (m + p + 1) :].reshape(p, n),
    )


def _ends(step: Array, model: InnovationModel) -> Array:
    n, width = model.order, model.B.shape[1] + len(model.C) + 1
    return step[n : n + n * width].reshape(n, width)[:, -1]


def _normal_equations(spectra: Spectra, model: InnovationModel, start: Array, covariance: Array, lines: int) -> tuple[Array, Array]:
    """Re JᴴJ (k, k) and Re Jᴴε (k,) of the whitened errors."""
    whitener = np.linalg.inv(np.linalg.cholesky(covariance))
    count = len(spectra)
    drawn = np.sort(np.random.default_rng(0).choice(count, min(count, lines), replace=False))
    curvature: Array | None = None
    for some in _chunks(len(drawn), AT_ONCE):
        J = _derivatives(_Errors(spectra, model, start, drawn[some]), model, whitener)
        rows = np.concatenate([J.real, J.imag])
        part = (rows.T @ rows).astype(np.float64)
        curvature = part if curvature is None else curvature + part
    assert curvature is not None
    gradient = sum(_gradient(_Errors(spectra, model, start, some), model, whitener) for some in _chunks(count, AT_ONCE))
    return curvature * (count / len(drawn)), np.asarray(gradient)


def _turned(moving: Complex, r: int) -> Complex:
    """A quarter of a turn further on (F, 2r), each mode's states: what its frequency changes, where A X is what its decay does."""
    pairs = moving[:, : 2 * r].reshape(len(moving), r, 2)
    return np.stack([pairs[:, :, 1], -pairs[:, :, 0]], axis=2).reshape(len(moving), 2 * r)


def _derivatives(at: _Errors, model: InnovationModel, whitener: Array) -> NDArray[np.complex64]:
    """−∂ε (F p, k), whitened, in single precision: the direction of a step needs no more."""
    r, n, p = len(model.pairs), model.order, len(model.C)
    moving = (at.states @ model.A.T) * model.interval
    exact = at.sensitivity(whitener)
    seen = (whitener - exact @ model.K).astype(np.complex64)
    S, states, driving = (each.astype(np.complex64) for each in (exact, at.states, at.driving))
    shrinking, turning = S * moving[:, None, :], S[:, :, : 2 * r] * _turned(moving, r)[:, None, :]
    count, width = len(S), driving.shape[1]
    found = np.empty((count, p, n + n * width + p * n), dtype=np.complex64)
    found[:, :, 0 : 2 * r : 2], found[:, :, 1 : 2 * r : 2] = _by_mode(shrinking[:, :, : 2 * r], r), _by_mode(turning, r)
    found[:, :, 2 * r : n] = shrinking[:, :, 2 * r :]
    np.multiply(S[:, :, :, None], driving[:, None, None, :], out=found[:, :, n : n + n * width].reshape(count, p, n, width))
    np.multiply(seen[:, :, :, None], states[:, None, None, :], out=found[:, :, n + n * width :].reshape(count, p, p, n))
    return found.reshape(count * p, -1)


def _by_mode(columns: Complex, r: int) -> Complex:
    return np.asarray(columns.reshape(*columns.shape[:2], r, 2).sum(axis=3))


def _gradient(at: _Errors, model: InnovationModel, whitener: Array) -> Array:
    """Re Jᴴε (k,) of some frequencies, without J."""
    white, r = at.errors @ whitener.T, len(model.pairs)
    back = at.adjoint(whitener, white)
    moving = (at.states @ model.A.T) * model.interval
    shrinking = (back * moving.conj()).real.sum(axis=0)
    turning = (back[:, : 2 * r] * _turned(moving, r).conj()).real.sum(axis=0)
    first = np.stack([shrinking[: 2 * r].reshape(r, 2).sum(axis=1), turning.reshape(r, 2).sum(axis=1)], axis=1)
    driven, seen = (back.T @ at.driving.conj()).real, ((white @ whitener - back @ model.K).T @ at.states.conj()).real
    return np.concatenate([first.ravel(), shrinking[2 * r :], driven.ravel(), seen.ravel()])
