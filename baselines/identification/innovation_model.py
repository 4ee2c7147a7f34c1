"""The model that is identified: modes that voltages and innovations drive.

    x⁺ = A x + B u + K e,        y = C x + e,        cov e = Λ,

the steady Kalman filter of a plant with white loads and sensor noise, read as a model of what is measured (Ljung, System
Identification, 1999, §4.3). A is block diagonal, a rotation that shrinks for each mode and a number for each real pole, so that
frequencies and dampings are parameters of their own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

LEAST_POLE = 1e-3
"""A real pole of a sampled system that is negative, or hardly there, is begun with at this: no plant in continuous time has one."""


HALVINGS = 60
"""Of K, after which it is nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class InnovationModel(ReadOnly):
    """n = 2r + s states, m voltages, p readings, in the units that these are given in."""

    pairs: Complex
    """(r,): eigenvalue of each mode, with positive imaginary part, of the sampled system."""
    reals: Array
    """(s,): real eigenvalues, between 0 and 1."""
    B: Array
    """(n, m)."""
    C: Array
    """(p, n)."""
    K: Array
    """(n, p)."""
    covariance: Array
    """Λ (p, p) of the innovations."""
    interval: float
    """s."""

    @property
    def order(self) -> int:
        """Number of states, n."""
        return 2 * len(self.pairs) + len(self.reals)

    @property
    def A(self) -> Array:
        """(n, n), the modes first."""
        whole, r = np.diag(np.concatenate([np.repeat(self.pairs.real, 2), self.reals])), np.arange(0, 2 * len(self.pairs), 2)
        whole[r, r + 1], whole[r + 1, r] = self.pairs.imag, -self.pairs.imag
        return whole

    @property
    def predictor(self) -> Array:
        """A − K C (n, n): what remembers readings."""
        return np.asarray(self.A - self.K @ self.C)

    @property
    def poles(self) -> Complex:
        """(r + s,) rad/s in continuous time: one of each mode's two, then the real ones."""
        return np.asarray(np.log(np.concatenate([self.pairs, self.reals.astype(complex)])) / self.interval)

    @property
    def stable(self) -> bool:
        """Whether it is, and its predictor too."""
        own = np.abs(np.concatenate([self.pairs, self.reals])).max(initial=0.0)
        return bool(own < 1.0 and np.abs(np.linalg.eigvals(self.predictor)).max(initial=0.0) < 1.0)

    def steadied(self) -> InnovationModel:
        """Itself if it is ``stable``; else with K halved until its predictor is, as that of a stable model without K is."""
        found, halvings = self, 0
        while not found.stable and halvings < HALVINGS:
            found, halvings = replace(found, K=0.5 * found.K), halvings + 1
        return found

    def scaled(self, voltage: Array, reading: Array) -> InnovationModel:
        """The same for voltages and readings in other units: old ones times ``voltage`` (m,) and ``reading`` (p,)."""
        return replace(
            self,
            B=self.B / voltage,
            C=self.C * reading[:, None],
            K=self.K / reading,
            covariance=self.covariance * np.outer(reading, reading),
        )

    def simulated(self, voltages: Array) -> Array:
        """Readings (N, p) that voltages (N, m) alone bring about, from rest."""
        return _response(self.A, self.B, self.C, voltages)

    def one_step_errors(self, voltages: Array, readings: Array) -> Array:
        """Innovations (N, p): readings less what the rows before them let expect."""
        inputs, seen = np.hstack([self.B, self.K]), np.hstack([voltages, readings])
        return np.asarray(readings - _response(self.predictor, inputs, self.C, seen))


def _response(A: Array, B: Array, C: Array, inputs: Array) -> Array:
    """C x (N, p) of x⁺ = A x + B u from zero, mode by mode."""
    from scipy.signal import lfilter  # a second of imports, which nothing else of the baselines needs

    eigenvalues, vectors = np.linalg.eig(A)
    driven = inputs @ np.linalg.solve(vectors, B.astype(complex)).T
    states = np.stack([lfilter([0.0, 1.0], [1.0, -each], column) for each, column in zip(eigenvalues, driven.T, strict=True)])
    return np.asarray((states.T @ (C @ vectors).T).real)


def in_modes(A: Array, B: Array, C: Array, K: Array, covariance: Array, interval: float) -> InnovationModel:
    """A model in whatever coordinates in those of its modes, by ascending frequency; poles on or beyond the unit circle are taken a
    little way in, negative real ones to just above zero.
    """
    eigenvalues, vectors = np.linalg.eig(A)
    eigenvalues = _within(eigenvalues.astype(complex))
    rising = np.argsort(np.abs(np.log(eigenvalues)))
    turning = [k for k in rising if eigenvalues[k].imag > 0.0]
    alone = [k for k in rising if eigenvalues[k].imag == 0.0]
    columns = [part(vectors[:, k]) for k in turning for part in (np.real, np.imag)] + [vectors[:, k].real for k in alone]
    T = np.stack(columns, axis=1)
    inputs = np.linalg.solve(T, np.hstack([B, K]))
    return InnovationModel(
        pairs=eigenvalues[turning],
        reals=eigenvalues[alone].real,
        B=inputs[:, : B.shape[1]],
        C=C @ T,
        K=inputs[:, B.shape[1] :],
        covariance=covariance,
        interval=interval,
    )


def _within(eigenvalues: Complex) -> Complex:
    size = np.maximum(np.abs(eigenvalues), 1e-12)
    inside = eigenvalues * np.minimum(1.0, 0.9999 / size)
    return np.where((inside.imag == 0.0) & (inside.real < LEAST_POLE), LEAST_POLE + 0j, inside)
