"""Weights of a designer's own, in the plant's coordinates."""

from __future__ import annotations

from dataclasses import replace

from numpy.typing import ArrayLike

from baselines.design.instruments import checked_plant
from baselines.design.matrix import definite_matrix
from beamenv.plant.plant import Plant


def weighted(plant: Plant, Q: ArrayLike | None = None, R: ArrayLike | None = None) -> Plant:
    """The plant with the cost ∫(xᵀQx + uᵀRu)dt; what is None stays the plant's own.

    ``Q`` (n, n) weighs the state, of a blade x = [ω η; η̇] in energy coordinates, 1 being J/J, and must be symmetric and positive
    semidefinite; with either of them products xᵀNu have no weight;
    ``R`` (m, m) in J/V² weighs the voltages and must be symmetric and positive definite. Raises ValueError for anything else.
    """
    n, m = checked_plant(plant).B.shape
    if Q is None and R is None:
        return plant
    return replace(
        plant,
        cross_weight=None,
        state_weight=plant.state_weight if Q is None else definite_matrix("Q", Q, n, "semidefinite"),
        input_weight=plant.input_weight if R is None else definite_matrix("R", R, m, "definite"),
    )
