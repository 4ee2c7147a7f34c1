"""What stands between a law and a blade: the data acquisition that it reads, the drive that it commands, and their clock."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np

from baselines.design.controller import Array, Observes
from baselines.design.matrix import keep_matrices
from baselines.design.objects import instance
from beamenv.configuration import Choice, Number, checked
from beamenv.configuration.read_only import ReadOnly
from beamenv.plant.plant import Plant, drive_limit


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Instruments(ReadOnly):
    """Scales of the p measurements and the m voltages, the drive limits, and the interval between two decisions."""

    measurement_scale: Array
    """(p,): the measurement that an observation of 1 stands for, A, √J of a true state, or rad/s of a rotor speed."""
    voltage_scale: Array
    """(m,), V: the voltage that an action of 1 stands for."""
    voltage_limits: Array
    """(2, m), V: lower and upper drive limit."""
    interval: float
    """s: voltages are held over it."""
    observes: Observes = "observation"
    """What is measured: the readings, perhaps with the rotor speed or the truth, or the true state (n,), which no sensor offers."""

    def __post_init__(self) -> None:
        """Arrays of one's own, which nobody writes to; ``ValueError`` for scales and limits that no law could stand behind."""
        p, m = (np.size(each) for each in (self.measurement_scale, self.voltage_scale))
        keep_matrices(self, {"measurement_scale": (p,), "voltage_scale": (m,), "voltage_limits": (2, m)})
        object.__setattr__(self, "interval", checked("interval", self.interval, Number(gt=0.0, unit="s")))
        object.__setattr__(self, "observes", checked("observes", self.observes, Choice(get_args(Observes))))

    @classmethod
    def of(cls, plant: Plant, observes: Observes = "observation") -> Instruments:
        """Those of an environment around this plant, which takes and gives normalised numbers."""
        checked_plant(plant)
        observes = checked("observes", observes, Choice(get_args(Observes)))
        scale = np.ones(len(plant.A)) if observes == "state" else plant.sensor_full_scale
        beside = {"observation and speed": 1, "observation and truth": 2 + plant.B.shape[1] + 2 * len(plant.C)}
        scale = np.append(scale, np.ones(beside.get(observes, 0)))
        return cls(scale, drive_limit(plant), plant.voltage_limits, plant.control_interval, observes)

    @property
    def counts(self) -> tuple[int, int]:
        """How many measurements and how many voltages."""
        return len(self.measurement_scale), len(self.voltage_scale)

    def in_physical_units(self) -> Instruments:
        """The same for an environment made with ``physical_units=True``, which gives amperes and takes volts."""
        return replace(self, measurement_scale=np.ones_like(self.measurement_scale), voltage_scale=np.ones_like(self.voltage_scale))

    def fit(self, physical_units: bool) -> bool:
        """Whether an environment with or without physical units is what they are scaled for."""
        drive = self.voltage_scale if physical_units else self.drive(np.abs(self.voltage_limits).max(axis=0))
        return bool(np.allclose(drive, 1.0))

    def read(self, observation: Array) -> Array:
        """Measurement (…, p) in A from an observation."""
        return observation * self.measurement_scale

    def limit(self, voltage: Array) -> Array:
        """The voltage (…, m), V, as the drive lets it through."""
        return np.minimum(np.maximum(voltage, self.voltage_limits[0]), self.voltage_limits[1])  # np.clip starts slower

    def drive(self, voltage: Array) -> Array:
        """The action (…, m) that asks for a voltage in V."""
        return voltage / self.voltage_scale

    def __repr__(self) -> str:
        return f"Instruments({self.sizes})"

    @property
    def sizes(self) -> str:
        """In one line: what is measured and how many numbers, how many voltages, clock, limits and units."""
        low, high = self.voltage_limits[0].min(), self.voltage_limits[1].max()
        units = "physical units" if np.all(self.voltage_scale == 1.0) else "normalised units"
        counts = f"{self.observes} ({len(self.measurement_scale)}), {len(self.voltage_scale)} voltages"
        return f"{counts}; {1e3 * self.interval:.4g} ms; {low:.5g} … {high:.5g} V; {units}"


def checked_plant(plant: Any) -> Plant:
    """The plant; ``ValueError`` for what is none, such as the environment that has one."""
    return instance("plant", plant, Plant, "a beamenv.Plant, such as env.unwrapped.design_plant")


def checked_instruments(instruments: Any) -> Instruments:
    """The instruments; ``ValueError`` for what is none."""
    return instance("instruments", instruments, Instruments, "an Instruments, such as Instruments.of(plant)")
