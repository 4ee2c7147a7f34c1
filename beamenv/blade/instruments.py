"""The range of a blade's data acquisition, kept when another blade is put behind it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.sensors.kinds import PatchSensor, Sensor

Array = NDArray[np.float64]


def in_range(config: BladeConfig, full_scale: Array) -> BladeConfig:
    """The configuration with the ranges (p,) of its readings fixed: of the currents, or of each sensor that is listed."""
    if not config.sensors:
        return replace(config, sensor_full_scale=float(full_scale[0]))
    channels = iter(full_scale.tolist())
    ranged = []
    for sensor in config.sensors:
        own = [next(channels) for _ in range(channels_of(config, sensor))]
        ranged.append(replace(sensor, range=own[0]))
    return replace(config, sensors=tuple(ranged))


def channels_of(config: BladeConfig, sensor: Sensor) -> int:
    """How many readings a sensor has."""
    return config.patches.groups("sensors")[sensor.group].channels if isinstance(sensor, PatchSensor) else 1
