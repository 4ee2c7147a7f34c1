"""Many continuous Riccati equations at once, by structure-preserving doubling."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_continuous_are

Array = NDArray[np.float64]

MOST_DOUBLINGS = 40
SETTLED = 1e-8
"""Relative change of X after which doubling, which converges quadratically, would change no digit."""
RESIDUAL_LIMIT = 1e-11
"""Relative residual beyond which an equation is solved again, by SciPy."""


def solve_riccati(A: Array, G: Array, Q: Array) -> Array:
    """Stabilising X (N, n, n) of AᵀX + XA + Q − XGX = 0 for N equations; G, Q symmetric, positive semidefinite.

    Each argument is (N, n, n) or (1, n, n) for all. An equation whose residual stays above ``RESIDUAL_LIMIT`` is handed to
    ``scipy.linalg.solve_continuous_are``; ``numpy.linalg.LinAlgError`` when that fails too.
    """
    A, G, Q = (np.array(each) for each in np.broadcast_arrays(A, G, Q))
    solution = doubling(A, G, Q)
    for index in np.flatnonzero(~(relative_residual(A, G, Q, solution) <= RESIDUAL_LIMIT)):
        solution[index] = by_schur_vectors(A[index], G[index], Q[index])
    return solution


def doubling(A: Array, G: Array, Q: Array) -> Array:
    """X (N, n, n) by the structured doubling algorithm (Chu, Fan and Lin, Linear Algebra and its Applications 396, 2005)."""
    balance = np.sqrt(largest(Q) / np.maximum(largest(G), np.finfo(float).tiny))  # X = balance · X', of the size of one
    eye = np.eye(A.shape[-1])
    shift = cayley_shift(A)
    E, g, h = start_of_doubling(A, G * balance, Q / balance, shift)
    for _ in range(MOST_DOUBLINGS):
        inverse = np.linalg.inv(eye + g @ h)
        forward = E @ inverse
        change = transposed(E) @ (h @ (inverse @ E))
        g = symmetric(g + forward @ g @ transposed(E))
        h = symmetric(h + change)
        E = forward @ E
        size = largest(h)
        if np.all(largest(change) <= SETTLED * size) or not np.all(np.isfinite(size)):
            break
    return np.asarray(h * balance)


def start_of_doubling(A: Array, G: Array, Q: Array, shift: Array) -> tuple[Array, Array, Array]:
    """E₀, G₀, H₀: the Hamiltonian's Cayley transform with poles at ``shift`` (N, 1, 1), 1/s, in symplectic form."""
    eye = np.eye(A.shape[-1])
    inverse = np.asarray(np.linalg.inv(A - shift * eye), dtype=np.float64)
    middle = np.asarray(np.linalg.inv(transposed(A) - shift * eye + Q @ inverse @ G), dtype=np.float64)
    E = eye + 2.0 * shift * transposed(middle)
    return E, symmetric(2.0 * shift * inverse @ G @ middle), symmetric(2.0 * shift * middle @ Q @ inverse)


def cayley_shift(A: Array) -> Array:
    """(N, 1, 1), 1/s: between the slowest and the fastest dynamics, so that neither settles late."""
    squares = np.einsum("nij,nji->n", A, A)
    return 0.5 * np.sqrt(np.abs(squares) / A.shape[-1])[:, None, None]


def relative_residual(A: Array, G: Array, Q: Array, X: Array) -> Array:
    """‖AᵀX + XA + Q − XGX‖ over the sum of the terms' largest elements, (N,); NaN where X is."""
    linear, quadratic = X @ A, X @ G @ X
    size = 2.0 * largest(linear) + largest(Q) + largest(quadratic)
    return np.asarray((largest(linear + transposed(linear) + Q - quadratic) / size)[:, 0, 0])


def by_schur_vectors(A: Array, G: Array, Q: Array) -> Array:
    """One equation by SciPy; G is factored into B Bᵀ for it."""
    values, vectors = np.linalg.eigh(G)
    kept = values > 1e-14 * values[-1]
    factor = vectors[:, kept] * np.sqrt(values[kept])
    return np.asarray(solve_continuous_are(A, factor, Q, np.eye(int(kept.sum()))))


def largest(matrices: Array) -> Array:
    """(N, 1, 1): largest element in magnitude."""
    return np.abs(matrices).max(axis=(-2, -1), keepdims=True)


def transposed(matrices: Array) -> Array:
    """(N, n, n)."""
    return matrices.swapaxes(-1, -2)


def symmetric(matrices: Array) -> Array:
    """(N, n, n)."""
    return 0.5 * (matrices + transposed(matrices))
