"""Where sensors are on a blade, for pictures: which patch is read by which reading, and where the others sit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.instruments import channels_of
from beamenv.blade.shape import Skin, patch
from beamenv.sensors.kinds import PatchSensor, PointSensor, StrainGauge
from beamenv.sensors.strains import footprint

Array = NDArray[np.float64]
Channels = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class SensorPlaces:
    """Readings by what they are of."""

    of_patches: Channels
    """(s,): the reading of each sensor patch; −1 for one that is not read."""
    of_points: Channels
    """(k,): the readings of gauges and points."""
    points: tuple[Skin, ...]
    """(k,): each followed at one station."""

    @classmethod
    def on(cls, blade: Blade) -> SensorPlaces:
        """Those of a blade."""
        config, groups = blade.config, blade.config.patches.groups("sensors")
        patches = [np.full(group.count, -1) for group in groups]
        if not config.sensors:
            first = 0
            for k, group in enumerate(groups):
                patches[k], first = first + _channel(group.ganged, group.count), first + group.channels
            return cls(np.concatenate([np.zeros(0, dtype=np.intp), *patches]), np.zeros(0, dtype=np.intp), ())
        reading, channels, points = 0, [], []
        for sensor in config.sensors:
            if isinstance(sensor, PatchSensor):
                group = groups[sensor.group]
                patches[sensor.group] = reading + _channel(group.ganged, group.count)
            else:
                channels.append(reading)
                points.append(_skin(blade, sensor))
            reading += channels_of(config, sensor)
        return cls(np.concatenate([np.zeros(0, dtype=np.intp), *patches]), np.array(channels, dtype=np.intp), tuple(points))


def _channel(ganged: bool, count: int) -> Channels:
    return np.zeros(count, dtype=np.intp) if ganged else np.arange(count)


def _skin(blade: Blade, sensor: StrainGauge | PointSensor) -> Skin:
    """One point at one station."""
    beam = blade.beam
    if isinstance(sensor, StrainGauge):
        under = patch(beam, footprint(beam, sensor, "blade.sensors"), np.array([sensor.position]))
        return Skin(under.span, under.points.mean(axis=1, keepdims=True), under.angle)
    span = np.array([beam.length if sensor.position is None else sensor.position])
    return Skin(span, np.array(sensor.point)[None, None], beam.planform.angle(span))
