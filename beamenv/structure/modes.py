"""Natural frequencies and mode shapes of conservative gyroscopic systems M q̈ + G q̇ + K q = 0."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, solve_triangular

from beamenv.configuration.read_only import Sealed

Array = NDArray[np.float64]

LOST = 1e-6
"""Share of the lowest squared frequency that rounding of the highest may take: short elements on a slender blade take all of it."""


@dataclass(frozen=True, slots=True, eq=False)
class Modes(Sealed):
    """Modes in ascending order of frequency."""

    natural_frequencies: Array
    """(count,), rad/s."""
    mode_shapes: NDArray[np.float64] | NDArray[np.complex128]
    """(N, count): coefficients of the trial functions, of unit modal mass; complex, for q = Re(shape·exp(iωt)), with
    gyroscopic coupling."""
    families: tuple[str, ...]
    """lag, flap, extension or twist: where most of the mode's kinetic energy is."""
    participation: Array
    """(count, 4): share of the kinetic energy in lag, flap, extension and twist."""


def normal_modes(mass: Array, stiffness: Array, count: int | None = None) -> tuple[Array, Array]:
    """Frequencies (count,) and mass-normalised shapes (N, count) without gyroscopic coupling.

    A mode that has lost its stiffness (beyond the critical speed) is reported at zero frequency.
    """
    subset = None if count is None else (0, min(count, len(mass)) - 1)
    squares, shapes = eigh(stiffness, mass, subset_by_index=subset)
    if np.finfo(np.float64).eps * np.max(np.diagonal(stiffness) / np.diagonal(mass)) > LOST * squares[0]:
        return _lowest_modes(mass, stiffness, len(squares)) or (np.sqrt(np.maximum(squares, 0.0)), shapes)
    return np.sqrt(np.maximum(squares, 0.0)), shapes


def _lowest_modes(mass: Array, stiffness: Array, count: int) -> tuple[Array, Array] | None:
    """The same of M ψ = K ψ/ω², whose rounding is that of the lowest mode and not of the highest; None where K is not positive."""
    try:
        inverses, shapes = eigh(mass, stiffness, subset_by_index=(len(mass) - count, len(mass) - 1))
    except np.linalg.LinAlgError:
        return None
    frequencies = 1.0 / np.sqrt(np.maximum(inverses, np.finfo(np.float64).eps * inverses[-1]))[::-1]
    return frequencies, np.asarray(shapes[:, ::-1] * frequencies)


def whirling_modes(
    mass: Array, gyroscopic: Array, stiffness: Array, count: int | None = None
) -> tuple[Array, NDArray[np.complex128]]:
    """Frequencies (count,) and complex shapes (N, count) of unit modal mass with gyroscopic coupling.

    With M = L Lᵀ and L⁻¹ K L⁻ᵀ = C Cᵀ the state [Cᵀ Lᵀq; Lᵀq̇] obeys ẏ = S y with S skew, so i S is Hermitian and every
    frequency is exact to round-off of the largest. Raises ``numpy.linalg.LinAlgError`` where K is not positive definite.
    """
    root = np.asarray(np.linalg.cholesky(mass), dtype=np.float64)
    skew = skew_form(reduced(root, stiffness), reduced(root, gyroscopic))
    size = len(mass)
    last = size if count is None else min(count, size)
    eigenvalues, vectors = eigh(1j * skew, subset_by_index=(size, size + last - 1), driver="evr")
    shapes = solve_triangular(root, vectors[size:], lower=True, trans="T")
    modal_mass = np.einsum("ij,ij->j", shapes.conj(), mass @ shapes).real
    # S has the eigenvalues −iω for these vectors: conjugated, the shapes move as exp(+iωt).
    return np.asarray(eigenvalues), np.asarray(shapes.conj() / np.sqrt(modal_mass), dtype=np.complex128)


def whirling_frequencies(mass: Array, gyroscopic: Array, stiffness: Array) -> Array:
    """All N frequencies, rad/s, ascending; modes that have lost their stiffness are reported at zero."""
    root = np.asarray(np.linalg.cholesky(mass), dtype=np.float64)
    reduced_stiffness, reduced_gyroscopic = reduced(root, stiffness), reduced(root, gyroscopic)
    try:
        return stable_frequencies(reduced_stiffness, reduced_gyroscopic)
    except np.linalg.LinAlgError:
        return diverged_frequencies(reduced_stiffness, reduced_gyroscopic)


def reduced(root: Array, matrix: Array) -> Array:
    """L⁻¹ X L⁻ᵀ for the Cholesky factor L of M: the matrix in coordinates in which M is the identity."""
    half = solve_triangular(root, matrix, lower=True)
    return np.asarray(solve_triangular(root, half.T, lower=True).T)


def skew_form(stiffness: Array, gyroscopic: Array) -> Array:
    """S (..., 2N, 2N) of reduced matrices (..., N, N); ``numpy.linalg.LinAlgError`` where a K is not positive definite."""
    factor = np.asarray(np.linalg.cholesky(0.5 * (stiffness + np.swapaxes(stiffness, -1, -2))), dtype=np.float64)
    size = factor.shape[-1]
    skew = np.zeros((*factor.shape[:-2], 2 * size, 2 * size))
    skew[..., :size, size:] = np.swapaxes(factor, -1, -2)
    skew[..., size:, :size] = -factor
    skew[..., size:, size:] = -gyroscopic
    return skew


def stable_frequencies(stiffness: Array, gyroscopic: Array) -> Array:
    """All N frequencies (..., N), rad/s, ascending, of reduced matrices (..., N, N) with positive definite K."""
    skew = skew_form(stiffness, gyroscopic)
    return np.asarray(np.linalg.eigvalsh(1j * skew)[..., skew.shape[-1] // 2 :])


def diverged_frequencies(stiffness: Array, gyroscopic: Array) -> Array:
    """|Im λ| (..., N) of the first-order matrix past the critical speed, where some modes diverge (λ real); reduced matrices."""
    size = stiffness.shape[-1]
    first_order = np.zeros((*stiffness.shape[:-2], 2 * size, 2 * size))
    first_order[..., :size, size:] = np.eye(size)
    first_order[..., size:, :size] = -stiffness
    first_order[..., size:, size:] = -gyroscopic
    return np.sort(np.abs(np.linalg.eigvals(first_order).imag), axis=-1)[..., ::2]


def critical_speed(elastic_stiffness: Array, spin_stiffness: Array) -> float:
    """Speed (rad/s) at which K_e + Ω² K_Ω first loses its positive definiteness; infinite when it never does."""
    lowest = eigh(spin_stiffness, elastic_stiffness, eigvals_only=True, subset_by_index=(0, 0))[0]
    return float(1.0 / np.sqrt(-lowest)) if lowest < 0.0 else float("inf")


def energy_participation(mass: Array, mode_shapes: NDArray[np.complex128] | Array, blocks: list[NDArray[np.intp]]) -> Array:
    """Share of each mode's kinetic energy in each block of coefficients, (count, len(blocks))."""
    energies = []
    for block in blocks:
        part = mode_shapes[block]
        energies.append(np.einsum("ij,ij->j", part.conj(), mass[np.ix_(block, block)] @ part).real)
    shares = np.stack(energies, axis=1)
    return np.asarray(shares / shares.sum(axis=1, keepdims=True))
