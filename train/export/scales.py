"""What stands between a diagram, whose readings and voltages are of full scale and of the drive's limit, and the instruments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from beamenv.plant.plant import Plant, drive_limit
from train.export.blocks import Array, Block, Delay, Input, clip, pair
from train.export.diagram import Diagram


class Scales(NamedTuple):
    """Full scale (p,) of the sensors, what an action of 1 stands for (m,), V, and the limits (2, m) over it."""

    full_scale: Array
    drive: Array
    limits: Array

    @classmethod
    def of(cls, plant: Plant) -> Scales:
        """Those of an environment around the plant."""
        drive = drive_limit(plant)
        return cls(plant.sensor_full_scale, drive, plant.voltage_limits / drive)


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What a controller's own diagram comes to, between readings and actions."""

    action: Block
    """(m,), of the drive's limit."""
    following: Mapping[Delay, Block]
    further: tuple[Input, ...] = field(default=())
    """What is measured besides the sensors."""


def sensors_of(plant: Plant) -> tuple[Input, Block]:
    """What the sensors show, and what the data acquisition makes of it: over full scale, and clipped there."""
    sensors = Input(len(plant.C), ", ".join(each.unit for each in plant.sensors), label="sensors")
    # divided, not multiplied: a reading of full scale is then exactly 1, by which clipped readings are known
    return sensors, clip(pair("divide", sensors, plant.sensor_full_scale), (-1.0, 1.0), label="readings")


def behind_instruments(sensors: Input, drawn: Drawn, plant: Plant) -> Diagram:
    """From what is measured to voltages in V within the drive's limits."""
    volts = clip(drawn.action * drive_limit(plant), plant.voltage_limits, label="volts")
    return Diagram((sensors, *drawn.further), volts, drawn.following)
