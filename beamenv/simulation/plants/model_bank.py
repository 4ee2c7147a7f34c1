"""The bank of a model in the place of a blade: the model itself, or plants like it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.model_blade import ModelBlade
from beamenv.plant.energy import energy_coordinates
from beamenv.plant.plant import Plant
from beamenv.scenarios.tables import PlantVariation
from beamenv.simulation.plants.bank import Bank

Array = NDArray[np.float64]


def model_bank(model: ModelBlade, design: Blade, variation: PlantVariation) -> Bank:
    """As many plants as the scenario's bank has, where the model has a spread, drawn with its seed; or those that were given."""
    own = design == model  # the coordinates of another design are others
    if not model.varies:
        return Bank.single(model.truth, 0.0, _from_energy(model.truth) if own else None)
    plants = model.varied(variation.bank, variation.seed)
    views = np.stack([_from_energy(each) for each in plants]) if own and not model.others else None
    return Bank.gather(model.truth, plants, np.zeros(len(plants)), views).in_cost_axes()


def _from_energy(plant: Plant) -> Array:
    """(n, n): from energy coordinates to the plant's own, for rows."""
    own = energy_coordinates(plant)
    return np.eye(len(plant.A)) if own is None else own.back.T
