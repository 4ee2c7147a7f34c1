"""Newmark's direct integration: a response that shares nothing with the exact propagator it is there to check."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor
from scipy.linalg.lapack import dgetrs

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class NewmarkScheme:
    """α and δ of Bathe and Wilson (thesis Eqs. 3.9–3.11, a₃ and a₄ corrected)."""

    alpha: float = 0.25
    """0.25, the average acceleration, is second-order accurate; the thesis takes 0.75."""
    delta: float = 0.5

    def __post_init__(self) -> None:
        if not self.delta >= 0.5 or not self.alpha >= 0.25 * (0.5 + self.delta) ** 2:
            raise ValueError(
                f"alpha = {self.alpha!r}, delta = {self.delta!r} must satisfy delta ≥ 0.5 and alpha ≥ (0.5 + delta)²/4."
            )


def newmark(
    mass: Array,
    damping: Array,
    stiffness: Array,
    load: Callable[[float], Array],
    interval: float,
    steps: int,
    scheme: NewmarkScheme = NewmarkScheme(),
) -> Array:
    """Displacements (steps + 1, …, N) of M q̈ + C q̇ + K q = load(t), from rest at zero, every ``interval`` s.

    Matrices (…, N, N), for one blade or for many at once; ``damping`` holds the gyroscopic matrix too; ``load(t)`` gives (…, N).
    """
    alpha, delta = scheme.alpha, scheme.delta
    a0, a1, a2 = 1.0 / (alpha * interval**2), delta / (alpha * interval), 1.0 / (alpha * interval)
    a3, a4, a5 = 0.5 / alpha - 1.0, delta / alpha - 1.0, 0.5 * interval * (delta / alpha - 2.0)
    solved = _solver(stiffness + a0 * mass + a1 * damping)
    history = np.zeros((steps + 1, *mass.shape[:-1]))
    displacement, velocity = history[0], np.zeros(mass.shape[:-1])
    acceleration = np.linalg.solve(mass, load(0.0)[..., None])[..., 0]
    for step in range(1, steps + 1):
        inertia = _product(mass, a0 * displacement + a2 * velocity + a3 * acceleration)
        drag = _product(damping, a1 * displacement + a4 * velocity + a5 * acceleration)
        following = solved(load(step * interval) + inertia + drag)
        later = a0 * (following - displacement) - a2 * velocity - a3 * acceleration
        velocity = velocity + interval * ((1.0 - delta) * acceleration + delta * later)
        displacement, acceleration = following, later
        history[step] = following
    return history


def _product(matrices: Array, vectors: Array) -> Array:
    """(…, N)."""
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def _solver(matrices: Array) -> Callable[[Array], Array]:
    """What solves for right-hand sides (…, N), with each matrix factored once."""
    size = matrices.shape[-1]
    factored = [lu_factor(each) for each in matrices.reshape(-1, size, size)]

    def solved(right: Array) -> Array:
        columns = zip(factored, right.reshape(-1, size), strict=True)
        found = [dgetrs(*factors, column)[0] for factors, column in columns]  # lu_solve checks its arguments for longer
        return np.array(found).reshape(right.shape)

    return solved
