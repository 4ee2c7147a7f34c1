"""What may be wrong with a blade in a scenario: other plants than the design's, drive, data acquisition, failures, rotor loads.

Each is a frozen dataclass whose defaults mean "nothing". A range is [low, high], drawn uniformly for each episode.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Range = tuple[float, float]

SAME: Range = (1.0, 1.0)


@dataclass(frozen=True, slots=True)
class PlantVariation:
    """The true plant of an episode beside the design's. Plants are built once, as a bank that episodes draw from."""

    speed_ratio: Range = SAME
    """Ω over the configured speed."""
    ply_angle_ratio: Range = SAME
    """Of every ply angle."""
    modulus_ratio: Range = SAME
    """Of every modulus of the laminate."""
    mass_ratio: Range = SAME
    """Of the laminate's density."""
    damping_ratio: Range | None = None
    """Of every mode, drawn on a logarithmic scale; None: the configured one."""
    modes: int | None = None
    """Modes of the true plant; None: the configured number."""
    design_modes: int | None = None
    """Modes of the plant that controllers are designed for; None: the configured number."""
    spin_up: Range | None = None
    """rad/s: Ω(t) runs from the first to the second over the episode (``spin_up`` of the simulation); nothing else varies then."""
    bank: int = 128
    """Plants in the bank: a Latin hypercube of what varies."""
    seed: int = 0
    """Of the bank. Agents train on a bank of another seed than the one they are judged on."""

    def __post_init__(self) -> None:
        for name in ("speed_ratio", "ply_angle_ratio", "modulus_ratio", "mass_ratio"):
            _set_range(self, "plants", name, 0.01, 10.0)
        if self.damping_ratio is not None:
            _set_range(self, "plants", "damping_ratio", 1e-6, 0.9)
        if self.spin_up is not None:
            _set_range(self, "plants", "spin_up", 0.0, 1e6)
        for name in ("modes", "design_modes"):
            if getattr(self, name) is not None:
                check_count("plants", name, getattr(self, name), 1)
        check_count("plants", "bank", self.bank, 1)
        check_count("plants", "seed", self.seed, 0)
        if self.spin_up is not None and self.varies:
            raise ValueError("scenario: plants.spin_up cannot be combined with ranges of other plants.")

    @property
    def varies(self) -> bool:
        """Whether plants are drawn."""
        ratios = (self.speed_ratio, self.ply_angle_ratio, self.modulus_ratio, self.mass_ratio)
        return any(ratio != SAME for ratio in ratios) or self.damping_ratio is not None


@dataclass(frozen=True, slots=True)
class Drive:
    """The amplifiers and actuators."""

    voltage_limits: Range | None = None
    """V; None: the blade's own."""
    hysteresis: float = 0.0
    """Width of the free-strain loop over its stroke, both at full drive (``beamenv.simulation.signals.hysteresis``)."""
    delay: tuple[int, int] = (0, 0)
    """Control intervals, a whole number drawn for each episode, by which voltages come late."""

    def __post_init__(self) -> None:
        if self.voltage_limits is not None:
            _set_range(self, "drive", "voltage_limits", -math.inf, math.inf)
            if not self.voltage_limits[0] < 0.0 < self.voltage_limits[1]:
                raise ValueError(f"scenario: drive.voltage_limits is {self.voltage_limits!r}, but must enclose 0 V.")
        check_share("drive", "hysteresis", self.hysteresis, 0.5)
        ends = self.delay if isinstance(self.delay, Sequence) and not isinstance(self.delay, str) else (self.delay, self.delay)
        if len(ends) != 2:
            raise ValueError(f"scenario: drive.delay is {self.delay!r}, but must be a whole number or a range of two.")
        for end in ends:
            check_count("drive", "delay", end, 0, 100)
        if ends[0] > ends[1]:
            raise ValueError(f"scenario: drive.delay is {self.delay!r}, but a range must not fall.")
        object.__setattr__(self, "delay", (int(ends[0]), int(ends[1])))


@dataclass(frozen=True, slots=True)
class Acquisition:
    """The data acquisition."""

    dropout: float = 0.0
    """Share of readings, sensor by sensor, that are lost: the last one is then shown again."""

    def __post_init__(self) -> None:
        check_share("acquisition", "dropout", self.dropout, 0.99)


@dataclass(frozen=True, slots=True)
class Failures:
    """What is broken from the start of an episode; which one is drawn, every one equally likely."""

    dead_actuators: int = 0
    """Actuators that do nothing and store nothing."""
    faulty_sensors: int = 0
    """Sensors that are dead (noise alone) or biased."""
    biased_share: float = 0.5
    """Share of faulty sensors that are biased instead of dead."""
    bias: Range = (0.05, 0.2)
    """Of full scale, of either sign."""

    def __post_init__(self) -> None:
        check_count("failures", "dead_actuators", self.dead_actuators, 0)
        check_count("failures", "faulty_sensors", self.faulty_sensors, 0)
        check_share("failures", "biased_share", self.biased_share, 1.0)
        _set_range(self, "failures", "bias", 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Rotor:
    """Loads that come with the revolution of the rotor, and turbulence."""

    harmonics: tuple[float, ...] = ()
    """N/m: mean amplitude of the line load at 1, 2, … per revolution. Each is drawn between half and one and a half of it, with
    a phase and a direction of its own."""
    turbulence: float = 0.0
    """σ, N/m, in lag and in flap each."""
    turbulence_time: float = 0.02
    """τ, s. The spectrum is Dryden's longitudinal one, S(ω) = 2σ²τ/(1 + (ωτ)²), two-sided with ∫S dω/2π = σ²; held and
    sampled exactly."""

    def __post_init__(self) -> None:
        harmonics: Any = self.harmonics
        if not isinstance(harmonics, Sequence) or isinstance(harmonics, str):
            raise ValueError(f"scenario: rotor.harmonics is {self.harmonics!r}, but must be a list of amplitudes in N/m.")
        for value in (*self.harmonics, self.turbulence):
            if not _is_number(value) or value < 0.0:
                raise ValueError(f"scenario: rotor has {value!r} N/m, but loads must be zero or positive numbers.")
        object.__setattr__(self, "harmonics", tuple(float(value) for value in self.harmonics))
        if not (_is_number(self.turbulence_time) and self.turbulence_time > 0.0):
            raise ValueError(
                f"scenario: rotor.turbulence_time is {self.turbulence_time!r}, but must be a positive number of seconds."
            )


def checked_range(name: str, value: Any, least: float, most: float) -> Range:
    """The range as two floats; a single number means both ends. ``ValueError`` for what is none within the bounds."""
    ends = value if isinstance(value, Sequence) and not isinstance(value, str) else (value, value)
    if len(ends) != 2 or not all(_is_number(end) and least <= end <= most for end in ends) or ends[0] > ends[1]:
        bound = "" if least == -math.inf else f" not below {least:g}"
        bound += "" if most == math.inf else f" nor above {most:g}"
        raise ValueError(f"scenario: {name} is {value!r}, but must be a number or a range [low, high] of finite numbers{bound}.")
    return float(ends[0]), float(ends[1])


def _set_range(owner: Any, table: str, name: str, least: float, most: float) -> None:
    object.__setattr__(owner, name, checked_range(f"{table}.{name}", getattr(owner, name), least, most))


def check_count(table: str, name: str, value: Any, least: int, most: int = 10**9) -> None:
    """``ValueError`` unless the value is a whole number within the bounds."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise ValueError(f"scenario: {table}.{name} is {value!r}, but must be a whole number from {least} to {most}.")


def check_share(table: str, name: str, value: Any, most: float) -> None:
    """``ValueError`` unless the value is from 0 to ``most``."""
    if not _is_number(value) or not 0.0 <= value <= most:
        raise ValueError(f"scenario: {table}.{name} is {value!r}, but must be a number from 0 to {most:g}.")


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool) and math.isfinite(value)
