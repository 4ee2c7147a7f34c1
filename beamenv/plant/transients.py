"""What comes of forces that suddenly set in: how far sensors go and what it costs, while the plant swings into its new rest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from beamenv.plant.matrices import PlantMatrices

Array = NDArray[np.float64]

PERIODS = 5.0
"""Of the first mode, over which it is looked at."""

MOST_SAMPLES = 5_000
"""Instants that are looked at; slower plants are looked at less often."""


class Transient(NamedTuple):
    """The largest of all forces and instants."""

    outputs: Array
    """(p,): magnitude of C x."""
    cost: float
    """xᵀQx."""


def after_sudden(plant: PlantMatrices, forces: Array) -> Transient:
    """Of each of ``forces`` (n, k), columns f of ẋ = A x + f that set in at rest, one by one; the plant must be stable."""
    steps = int(np.ceil(PERIODS * 2.0 * np.pi / plant.natural_frequencies[0] / plant.control_interval))
    every = -(-steps // MOST_SAMPLES)
    transition = expm(plant.A * (every * plant.control_interval))
    rest = -np.linalg.solve(plant.A, forces)
    offset, outputs, cost = -rest, np.zeros(len(plant.C)), 0.0
    for _ in range(-(-steps // every)):
        offset = transition @ offset
        state = rest + offset
        outputs = np.maximum(outputs, np.abs(plant.C @ state).max(axis=1, initial=0.0))
        cost = max(cost, float(np.einsum("ik,ij,jk->k", state, plant.state_weight, state).max(initial=0.0)))
    return Transient(outputs, cost)
