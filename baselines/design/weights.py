"""Weights of a designer's own, in the plant's coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.controller import Array
from baselines.design.instruments import checked_plant
from baselines.design.matrix import real_matrix
from beamenv.plant.plant import Plant

_ROUNDING = 1e-9
"""Of the largest entry: what an asymmetry or a negative eigenvalue may come to by rounding."""


def weighted(plant: Plant, Q: ArrayLike | None = None, R: ArrayLike | None = None) -> Plant:
    """The plant with the cost ∫(xᵀQx + uᵀRu)dt; what is None stays the plant's own.

    ``Q`` (n, n) weighs the state x = [ω η; η̇] in energy coordinates, 1 being J/J, and must be symmetric and positive semidefinite;
    ``R`` (m, m) in J/V² weighs the voltages and must be symmetric and positive definite. Raises ValueError for anything else.
    """
    n, m = checked_plant(plant).B.shape
    return replace(
        plant,
        state_weight=plant.state_weight if Q is None else _checked("Q", Q, n, "semidefinite"),
        input_weight=plant.input_weight if R is None else _checked("R", R, m, "definite"),
    )


def _checked(name: str, value: ArrayLike, size: int, definite: str) -> Array:
    weight = real_matrix(name, value, (size, size))
    rounding = _ROUNDING * np.abs(weight).max()
    if np.abs(weight - weight.T).max() > rounding:
        raise ValueError(f"{name} differs from its transpose by {np.abs(weight - weight.T).max():.3g}, but must be symmetric.")
    lowest = float(np.linalg.eigvalsh(weight).min())
    if lowest < -rounding if definite == "semidefinite" else lowest <= 0.0:
        raise ValueError(f"{name} has the eigenvalue {lowest:.3g}, but must be positive {definite}.")
    return weight
