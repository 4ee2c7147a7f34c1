"""What sensor patches show of their own warming: charge that the change of their polarisation sets free.

A sheet of area A, free to expand, gives the charge p A ΔT. In the unit that charges are counted in here, that of Eq. 4.37 of the
thesis, ∫ D dA over its face, it is that whatever the way of its electrodes. The blade strains a sheet in its walls otherwise than
it would expand: the piezoelectric charge of the difference comes on top (secondary pyroelectricity).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.configuration import Refused
from beamenv.patches.operators import charge_per_kelvin
from beamenv.sensors.kinds import PatchCharge, PatchCurrent, Sensor
from beamenv.structure.held_and_heated import check_expansion
from beamenv.structure.walls.curves import ROOM

Array = NDArray[np.float64]


def pyroelectric_readings(blade: Blade, drawn: tuple[float, float]) -> Array:
    """(2, p): readings in full scales per K and control interval, and per K, of a blade at its own temperature, else at the one
    nearest to room temperature of those that are ``drawn`` (K); ``ValueError`` where no patch is read.
    """
    config, scale = blade.config, blade.truth.sensor_full_scale
    groups = config.patches.groups("sensors")
    for path, group in config.patches.named_groups():
        if group in groups:
            check_expansion(f"blade.{path}.material.lamina", group.patch.lamina)
    warm = blade.beam if config.beam.temperatures is not None else replace(blade.beam, temperature=float(np.clip(ROOM, *drawn)))
    charges = [charge_per_kelvin(warm, group) for group in groups]
    per_rate = 1.0 / config.control_interval
    parts = [(each, per_rate, 0.0) for each in charges]
    if config.sensors:
        parts = [_of_sensor(sensor, charges, per_rate) for sensor in config.sensors]
    found = np.concatenate([np.stack([rate * own, kept * own]) for own, rate, kept in parts], axis=1)
    if not found.any():
        raise Refused("scenario.plants.pyroelectric", True, "False where no currents or charges of pyroelectric patches are read")
    return np.asarray(found / scale)


def _of_sensor(sensor: Sensor, charges: list[Array], per_rate: float) -> tuple[Array, float, float]:
    """Charges per K of the patches that a sensor reads, and what it shows of them per K and interval, and per K."""
    if isinstance(sensor, PatchCurrent):
        return charges[sensor.group], per_rate, 0.0
    if isinstance(sensor, PatchCharge):
        return charges[sensor.group], 0.0, 1.0
    return np.zeros(1), 0.0, 0.0
