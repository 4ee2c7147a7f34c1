"""What each sensor of a blade feels of its motion and of the voltages on its actuators, one row for each reading."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.configuration.read_only import ReadOnly
from beamenv.patches import PatchLayout
from beamenv.plant.signals import Signal
from beamenv.sensors.kinds import UNITS, Accelerometer, Displacement, PatchCharge, PatchSensor, Sensor, StrainGauge
from beamenv.sensors.points import along, felt_acceleration, point_rows
from beamenv.sensors.strains import footprint, gauge_rows, local_strains
from beamenv.structure import RotatingBeam

Array = NDArray[np.float64]
Three = tuple[Array, Array, Array]


@dataclass(frozen=True, slots=True, eq=False)
class SensorRows(ReadOnly):
    """p readings y = R q + S q̇ + T q̈ of a blade with N trial functions q and m voltages, and what holds when it is at rest."""

    position: Array
    """R (p, N)."""
    rate: Array
    """S (p, N)."""
    acceleration: Array
    """T (p, N)."""
    coriolis: Array
    """(p, N): what of S is in proportion to the speed, per rad/s."""
    euler: Array
    """(p, N): what is added to R while the speed changes, per rad/s²."""
    static_position: Array
    """(p, m) of R q per V in the static state, with strains that the trial functions cannot follow."""
    static_rate: Array
    """(p, m) likewise of S q, whose rate is read."""
    with_base: Array
    """(p, 3): what accelerometers feel of the base's acceleration along lag, flap and span."""
    item: NDArray[np.intp]
    """(p,) which of the sensors, as they are listed, a reading is of."""
    signals: tuple[Signal, ...]
    """(p,)"""


@dataclass(frozen=True, slots=True, eq=False)
class OnBlade:
    """What the rows are made from."""

    beam: RotatingBeam
    layout: PatchLayout
    speed: float
    charges: Array
    """(c, N), C, of all sensor patches."""
    static_charges: Array
    """(c, m), C/V."""
    static: Array
    """K⁻¹F (N, m)."""
    local_share: Array
    """(N, m): K_e⁻¹F of the blade at rest."""


def sensor_rows(blade: OnBlade, sensors: Sequence[Sensor]) -> SensorRows:
    """The rows of sensors; ``ValueError`` for one that is not on the blade, or a group of patches that it has not."""
    each = [_rows(blade, sensor, f"blade.sensors[{k}]") for k, sensor in enumerate(sensors)]
    position, rate, acceleration, static_position, static_rate = (np.concatenate(parts) for parts in zip(*each, strict=True))
    turning = [_turning(blade, sensor, f"blade.sensors[{k}]") for k, sensor in enumerate(sensors)]
    item = np.repeat(np.arange(len(each)), [len(parts[0]) for parts in each])
    felt = [along(each.direction) if isinstance(each, Accelerometer) else np.zeros(3) for each in sensors]
    signals = tuple(Signal(f"{sensors[k].kind} {j}", UNITS[sensors[k].kind]) for j, k in enumerate(item.tolist()))
    coriolis, euler = np.array(turning)[item].swapaxes(0, 1)
    return SensorRows(
        position=position,
        rate=rate,
        acceleration=acceleration,
        coriolis=coriolis,
        euler=euler,
        static_position=static_position,
        static_rate=static_rate,
        with_base=np.array(felt)[item],
        item=item,
        signals=signals,
    )


def _rows(blade: OnBlade, sensor: Sensor, name: str) -> tuple[Array, ...]:
    """R, S, T and the static responses of one sensor, (channels, …) each."""
    if isinstance(sensor, PatchSensor):
        return _of_patches(blade, sensor, name)
    none, m = np.zeros(blade.beam.space.size), blade.static.shape[1]
    if isinstance(sensor, StrainGauge):
        inlay = footprint(blade.beam, sensor, name)
        row, local = (gauge_rows(blade.beam, sensor, inlay, speed) for speed in (blade.speed, 0.0))
        exact = local_strains(blade.beam, blade.layout, sensor, inlay) + row @ blade.static - local @ blade.local_share
        return _one((row, none, none), exact, np.zeros(m))
    rows = point_rows(blade.beam, sensor.position, sensor.point, name)
    direction = along(sensor.direction)
    if isinstance(sensor, Accelerometer):
        felt = felt_acceleration(rows, direction, blade.speed)
        return _one(felt, felt[0] @ blade.static, felt[1] @ blade.static)
    row = direction @ rows.moved
    if isinstance(sensor, Displacement):
        return _one((row, none, none), row @ blade.static, np.zeros(m))
    return _one((none, row, none), np.zeros(m), row @ blade.static)


def _turning(blade: OnBlade, sensor: Sensor, name: str) -> Array:
    """(2, N): what an accelerometer feels of a rate per rad/s of speed, and of a displacement per rad/s² of its change."""
    if not isinstance(sensor, Accelerometer):
        return np.zeros((2, blade.beam.space.size))
    rows, direction = point_rows(blade.beam, sensor.position, sensor.point, name), along(sensor.direction)
    return np.stack([felt_acceleration(rows, direction, 1.0)[1], felt_acceleration(rows, direction, 0.0, 1.0)[0]])


def _one(rows: Three, static_position: Array, static_rate: Array) -> tuple[Array, ...]:
    return tuple(each[None] for each in (*rows, static_position, static_rate))


def _of_patches(blade: OnBlade, sensor: PatchSensor, name: str) -> tuple[Array, ...]:
    groups = blade.layout.groups("sensors")
    if sensor.group >= len(groups):
        allowed = f"below {len(groups)}, the groups in blade.patches.sensors" if groups else "of a blade with sensor patches"
        raise Refused(f"{name}.group", sensor.group, allowed)
    first = sum(group.channels for group in groups[: sensor.group])
    own = slice(first, first + groups[sensor.group].channels)
    charges, static = blade.charges[own], blade.static_charges[own]
    none, still = np.zeros_like(charges), np.zeros_like(static)
    if isinstance(sensor, PatchCharge):
        return charges, none, none, static, still
    return none, charges, none, still, static


def needs_filter(sensors: Sequence[Sensor]) -> bool:
    """Whether some sensor feels loads at once, which only a filter makes an average of."""
    return any(isinstance(each, Accelerometer) for each in sensors)
