"""The configuration of the blade that controllers are designed for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.held_load import under_reference
from beamenv.blade.instruments import in_range
from beamenv.blade.model_blade import DRIVE
from beamenv.blade.presets import PRESETS, blade_config
from beamenv.configuration import Choice, Refused, checked, read
from beamenv.scenarios.scenario import Scenario


def driven(config: BladeConfig, chosen: Scenario) -> BladeConfig:
    """The blade with the drive that a scenario gives the default blade, of ±1500 V, as shares of its own."""
    limits = chosen.drive.voltage_limits
    if limits is None:
        return config
    share = max(map(abs, config.voltage_limits)) / DRIVE
    return replace(config, voltage_limits=(share * limits[0], share * limits[1]))


def with_modes(config: BladeConfig, **modes: int | None) -> BladeConfig:
    """The blade with those numbers of modes that a scenario gives."""
    given = {name: number for name, number in modes.items() if number is not None}
    return replace(config, **given) if given else config  # type: ignore[arg-type]


def design_config(preset: str, speed: float | None, design: Any) -> BladeConfig:
    """A name is a preset; a dictionary changes ``preset`` at ``speed``, not the true blade's own changes to it."""
    if not isinstance(design, (BladeConfig, Mapping)):
        return blade_config(checked("design", design, Choice(PRESETS, BladeConfig)), None, speed)
    return read(blade_config(preset, None, speed), design, "design")


def same_electronics(design: BladeConfig, true: Blade) -> Blade:
    """The design blade behind the very sensors' range, drive and clock that the true one has."""
    for name in ("control_interval", "voltage_limits"):
        if getattr(design, name) != getattr(true.config, name):
            raise Refused(f"design.{name}", getattr(design, name), f"the true blade's, {getattr(true.config, name)!r}")
    if design.sensors == true.config.sensors and (design.sensors or design.sensor_full_scale is None):
        design = in_range(design, true.plant.sensor_full_scale)
    if design.reference_load is None:
        design = under_reference(design, true.reference_load)
    designed = true.as_beam.changed(design)
    shapes = [(plant.B.shape[1], len(plant.C)) for plant in (designed.plant, true.plant)]
    if shapes[0] != shapes[1]:
        raise ValueError(f"design has {shapes[0]} voltages and sensors, but must have as many as the true blade, {shapes[1]}.")
    return designed
