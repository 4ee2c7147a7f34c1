"""Sensors as a user describes them, told apart by their ``kind``."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np

from beamenv.configuration import Choice, Count, Number, Numbers, Refused, Text, configuration
from beamenv.configuration.numbers import DEGREES
from beamenv.structure.walls.inlay import FACE

LARGEST = 1e9
"""Either way, of lengths (m), directions and loads (N, N/m or m/s²): beyond, a number is a mistake."""
Metres = Number(ge=-LARGEST, le=LARGEST, unit="m")
Point = Annotated[tuple[float, ...], Numbers(Metres, least=2, most=2)]
Range = Annotated[float | None, Number(ge=1e-15, le=1e9)]
Noise = Annotated[float | None, Number(ge=0.0, le=100.0)]
Vector = Annotated[tuple[float, ...], Numbers(Number(ge=-LARGEST, le=LARGEST), least=3, most=3)]


@configuration("blade.sensors")
class PatchCurrent:
    """Currents of a group of sensor patches, A: the rate of their charges, behind a current amplifier."""

    group: Annotated[int, Count(0)] = 0
    """Which of the groups in ``blade.patches.sensors``, from 0; one reading for each of its patches."""
    range: Range = None
    """A that a reading of 1 stands for; None: ``blade.sensor_full_scale``, or what fits."""
    noise: Noise = None
    """Standard deviation of one sample over the range; None: ``blade.sensor_noise_fraction``."""
    kind: Annotated[str, Choice(("current",))] = "current"


@configuration("blade.sensors")
class PatchCharge:
    """Charges of a group of sensor patches, C, behind a charge amplifier."""

    group: Annotated[int, Count(0)] = 0
    """Which of the groups in ``blade.patches.sensors``, from 0; one reading for each of its patches."""
    range: Range = None
    """C that a reading of 1 stands for; None: what fits."""
    noise: Noise = None
    """Standard deviation of one sample over the range; None: ``blade.sensor_noise_fraction``."""
    kind: Annotated[str, Choice(("charge",))] = "charge"


@configuration("blade.sensors")
class StrainGauge:
    """A strain gauge on a face of a wall: the strain of vibration along its axis, in the mean of its grid."""

    position: Annotated[float, Number(ge=0.0, unit="m")]
    """m along the span from the clamp to its middle."""
    wall: Annotated[str, Text()] = "top"
    offset: Annotated[float, Metres] = 0.0
    """m along the contour from the middle of the wall to that of the gauge, at the root."""
    face: Annotated[str, FACE] = "outer"
    angle_deg: Annotated[float, DEGREES] = 0.0
    """Of its axis from the span towards the contour's tangent: 0 is along the span."""
    length: Annotated[float, Number(gt=0.0, unit="m")] = 0.003
    """m, of its grid along the span."""
    width: Annotated[float, Number(gt=0.0, unit="m")] = 0.003
    """m, across."""
    range: Range = None
    """Strain that a reading of 1 stands for; None: what fits."""
    noise: Noise = None
    """Standard deviation of one sample over the range; None: ``blade.sensor_noise_fraction``."""
    kind: Annotated[str, Choice(("strain-gauge",))] = "strain-gauge"


@configuration("blade.sensors")
class Displacement:
    """A displacement sensor (laser triangulation) that turns with the hub: how far a point is from where it stands, m."""

    position: Annotated[float | None, Number(ge=0.0, unit="m")] = None
    """m along the span from the clamp; None: the tip."""
    point: Point = (0.0, 0.0)
    """m: x and y in the section, which turns with the pretwist, from the pitch axis; it need not be in a wall."""
    direction: Vector = (0.0, 1.0, 0.0)
    """Along lag, flap and span; of any length."""
    range: Range = None
    """m that a reading of 1 stands for; None: what fits."""
    noise: Noise = None
    """Standard deviation of one sample over the range; None: ``blade.sensor_noise_fraction``."""
    kind: Annotated[str, Choice(("displacement",))] = "displacement"

    def __post_init__(self) -> None:
        check_direction(self.direction)


@configuration("blade.sensors")
class Velocity:
    """A laser vibrometer that turns with the hub: the velocity of a point along its beam, m/s."""

    position: Annotated[float | None, Number(ge=0.0, unit="m")] = None
    """m along the span from the clamp; None: the tip."""
    point: Point = (0.0, 0.0)
    """m: x and y in the section, which turns with the pretwist, from the pitch axis."""
    direction: Vector = (0.0, 1.0, 0.0)
    """Along lag, flap and span; of any length."""
    range: Range = None
    """m/s that a reading of 1 stands for; None: what fits."""
    noise: Noise = None
    """Standard deviation of one sample over the range; None: ``blade.sensor_noise_fraction``."""
    kind: Annotated[str, Choice(("velocity",))] = "velocity"

    def __post_init__(self) -> None:
        check_direction(self.direction)


@configuration("blade.sensors")
class Accelerometer:
    """An accelerometer on the blade, m/s²: how the acceleration of its point against inertial space, along its own axis that turns
    with the section, differs from that of the blade as it turns and nothing vibrates. Gravity is left out.
    """

    position: Annotated[float | None, Number(ge=0.0, unit="m")] = None
    """m along the span from the clamp; None: the tip."""
    point: Point = (0.0, 0.0)
    """m: x and y in the section, which turns with the pretwist, from the pitch axis."""
    direction: Vector = (0.0, 1.0, 0.0)
    """Along lag, flap and span; of any length."""
    range: Range = None
    """m/s² that a reading of 1 stands for; None: what fits."""
    noise: Noise = None
    """Standard deviation of one sample over the range; None: ``blade.sensor_noise_fraction``."""
    kind: Annotated[str, Choice(("accelerometer",))] = "accelerometer"

    def __post_init__(self) -> None:
        check_direction(self.direction)


PatchSensor = PatchCurrent | PatchCharge
PointSensor = Displacement | Velocity | Accelerometer
Sensor = PatchSensor | StrainGauge | PointSensor

SENSORS: Mapping[str, type[Any]] = MappingProxyType(
    {
        "current": PatchCurrent,
        "charge": PatchCharge,
        "strain-gauge": StrainGauge,
        "accelerometer": Accelerometer,
        "velocity": Velocity,
        "displacement": Displacement,
    }
)

UNITS: Mapping[str, str] = MappingProxyType(
    {"current": "A", "charge": "C", "strain-gauge": "", "accelerometer": "m/s²", "velocity": "m/s", "displacement": "m"}
)


def check_direction(direction: tuple[float, ...], name: str = "direction") -> None:
    """``ValueError`` for one of no length."""
    if not np.linalg.norm(direction) > 0.0:
        raise Refused(name, direction, "one that is not zero")
