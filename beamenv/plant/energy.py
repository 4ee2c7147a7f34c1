"""Plants in coordinates of their energy, whatever coordinates they came in."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed
from beamenv.plant.plant import Plant

Array = NDArray[np.float64]

_NONE = 1e-12
"""Of the largest eigenvalue: an energy this small is none, but for rounding."""


class EnergyCoordinates(NamedTuple):
    """x' = T x, of which ½ Σ x'² of the first b is the energy; the others are orthonormal to each other."""

    there: Array
    """T (n, n)."""
    back: Array
    """T⁻¹ (n, n)."""
    known: int
    """b, the rank of the energy: 0 where none is known."""


def energy_coordinates(plant: Plant) -> EnergyCoordinates | None:
    """Those of a plant; None where its own are such."""
    if plant.in_energy_coordinates:
        return None
    values, vectors = np.linalg.eigh(np.asarray(plant.energy))
    values, vectors = values[::-1], vectors[:, ::-1]
    known = int(np.count_nonzero(values > _NONE * max(float(values[0]), 0.0)))
    size = np.append(np.sqrt(2.0 * values[:known]), np.ones(len(values) - known))
    return EnergyCoordinates(sealed(size[:, None] * vectors.T), sealed(vectors / size), known)


def in_energy_coordinates(plant: Plant) -> Plant:
    """The same plant, with states of which ½ Σ x² of all but the last, its ``electronic_states``, is the energy."""
    found = energy_coordinates(plant)
    if found is None:
        return plant
    there, back, known = found
    weight = back.T @ plant.state_weight @ back
    return replace(
        plant,
        A=sealed(there @ plant.A @ back),
        B=sealed(there @ plant.B),
        C=sealed(plant.C @ back),
        disturbance_input=sealed(there @ plant.disturbance_input),
        tip_displacement=sealed(plant.tip_displacement @ back),
        strain=sealed(plant.strain @ back),
        state_weight=sealed(0.5 * (weight + weight.T)),
        cross_weight=sealed(back.T @ np.asarray(plant.cross_weight)),
        energy=None,
        electronic_states=len(plant.A) - known,
    )
