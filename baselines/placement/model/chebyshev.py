"""Functions of the span as Chebyshev series: sampled once, integrated once, evaluated anywhere by one product."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ChebyshevSpan:
    """The piece 0 … ``end`` (m) of the span with polynomials T_k(2z/end − 1), k < ``count``."""

    end: float
    count: int

    @property
    def nodes(self) -> Array:
        """(count − 1,): where a function is sampled; its integral then has ``count`` coefficients."""
        return 0.5 * self.end * (1.0 + chebyshev.chebpts1(self.count - 1))

    def integral(self, samples: Array) -> Array:
        """(count, …): coefficients of ∫₀ᶻ f dσ from f at the nodes (count − 1, …)."""
        degrees = np.arange(self.count - 1)
        basis = np.cos(np.outer(degrees, np.arccos(chebyshev.chebpts1(self.count - 1))))
        norm = np.where(degrees == 0, 1.0, 2.0) / (self.count - 1)
        series = np.tensordot(norm[:, None] * basis, samples, axes=1)
        return np.asarray(chebyshev.chebint(series, lbnd=-1.0, scl=0.5 * self.end, axis=0))

    def values(self, z: Array) -> Array:
        """T_k at z (…,) in m: (…, count)."""
        angle = np.arccos(self._reference(z))
        return np.cos(angle[..., None] * np.arange(self.count))

    def slopes(self, z: Array) -> Array:
        """dT_k/dz = k U_{k−1}·2/end at z (…,): (…, count), 1/m."""
        x = self._reference(z)
        second = np.zeros((self.count, *x.shape))
        second[1:2] = 1.0
        for k in range(2, self.count):
            second[k] = 2.0 * x * second[k - 1] - second[k - 2]
        return np.ascontiguousarray(np.arange(self.count) * np.moveaxis(second, 0, -1) * (2.0 / self.end))

    def _reference(self, z: Array) -> Array:
        return np.clip(2.0 * np.asarray(z) / self.end - 1.0, -1.0, 1.0)
