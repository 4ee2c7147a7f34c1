"""Symmetric and skew matrices by their upper triangles: half the memory, and half the products."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed

Array = NDArray[np.float64]


def packed(matrices: Array) -> Array:
    """Upper triangles (…, n (n + 1)/2) of matrices (…, n, n)."""
    rows, columns = np.triu_indices(matrices.shape[-1])
    return np.ascontiguousarray(matrices[..., rows, columns])


def symmetric_from(triangles: Array, size: int) -> Array:
    """Symmetric matrices (N, n, n) of upper triangles (N, n (n + 1)/2)."""
    return np.take(triangles, _places(size), axis=1).reshape(-1, size, size)


def skew_from(triangles: Array, size: int) -> Array:
    """Skew matrices (N, n, n) of upper triangles (N, n (n + 1)/2)."""
    return symmetric_from(triangles, size) * (1.0 - 2.0 * np.tri(size, k=-1))


@lru_cache(maxsize=8)
def _places(size: int) -> NDArray[np.intp]:
    """Where in the triangle each element of a matrix, row by row, is found (n²,)."""
    places = np.zeros((size, size), dtype=np.intp)
    places[np.triu_indices(size)] = np.arange(size * (size + 1) // 2)
    return sealed(np.maximum(places, places.T).ravel())
