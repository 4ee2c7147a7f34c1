"""A plant in the units of its instruments."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed
from beamenv.plant.matrices import PlantMatrices

Array = NDArray[np.float64]
AnyPlant = TypeVar("AnyPlant", bound=PlantMatrices)


def normalised(plant: AnyPlant) -> AnyPlant:
    """The plant as a controller meets it: voltages in units of the drive limit, currents in units of sensor full scale."""
    drive, full_scale = drive_limit(plant), plant.sensor_full_scale
    return replace(
        plant,
        B=sealed(plant.B * drive),
        C=sealed(plant.C / full_scale[:, None]),
        D=sealed(plant.D * drive / full_scale[:, None]),
        input_weight=sealed(plant.input_weight * np.outer(drive, drive)),
        cross_weight=sealed(np.asarray(plant.cross_weight) * drive),
        sensor_noise=sealed(plant.sensor_noise / np.outer(full_scale, full_scale)),
        voltage_limits=sealed(plant.voltage_limits / drive),
        sensor_full_scale=sealed(np.ones_like(full_scale)),
    )


def drive_limit(plant: PlantMatrices) -> Array:
    """(m,) V: the voltage an action of 1 stands for, the larger magnitude of the two limits."""
    return np.abs(plant.voltage_limits).max(axis=0)
