"""Configurations of a blade: frozen dataclasses that hold what a user says of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from beamenv.patches import PatchLayout
from beamenv.structure import AS4_3501_6, GRAPHITE_EPOXY, BoxSection, Lamina, Layup, RotatingBeam

MATERIALS: Mapping[str, Lamina] = MappingProxyType({"graphite-epoxy": GRAPHITE_EPOXY, "as4-3501-6": AS4_3501_6})

ON_EVERY_WALL = "all"


@dataclass(frozen=True, slots=True)
class BeamConfig:
    """The bare blade: a box of the thesis (§3.5) unless said otherwise."""

    length: float = 2.023
    """m."""
    width: float = 0.254
    """m, of the mid-line box along the chord."""
    depth: float = 0.0508
    """m, of the mid-line box."""
    thickness: float = 0.01016
    """m, of the walls."""
    hub_radius: float = 0.2023
    """m."""
    material: str | Lamina = "graphite-epoxy"
    """A name or a lamina."""
    ply_angles_deg: tuple[tuple[str, tuple[float, ...]], ...] = ((ON_EVERY_WALL, (30.0,) * 6),)
    """Degrees from the contour tangent, inner to outer face, for ("all", angles) or wall by wall; a list or a mapping will do."""
    pretwist_deg: float = 30.0
    presetting_deg: float = 0.0
    taper: float = 1.0
    shear: str = "higher_order"
    shear_flow: str = "consistent"
    terms: int = 10

    def __post_init__(self) -> None:
        object.__setattr__(self, "ply_angles_deg", as_ply_angles(self.ply_angles_deg))
        if isinstance(self.material, Mapping):
            object.__setattr__(self, "material", changed(GRAPHITE_EPOXY, self.material, "material"))
        elif isinstance(self.material, str) and self.material not in MATERIALS:
            raise ValueError(f"material = {self.material!r} of the beam must be one of {', '.join(MATERIALS)}, or a Lamina.")

    def build(self, layout: PatchLayout | None = None) -> RotatingBeam:
        """The blade, with the inlays of passive patches when a layout is given."""
        return RotatingBeam(
            section=BoxSection(self.width, self.depth, self.thickness),
            layup=self.layup(),
            length=self.length,
            hub_radius=self.hub_radius,
            pretwist_deg=self.pretwist_deg,
            presetting_deg=self.presetting_deg,
            taper=self.taper,
            shear=self.shear,
            shear_flow=self.shear_flow,
            terms=self.terms,
            inlays=layout.inlays(self.length) if layout else (),
        )

    def layup(self) -> Layup:
        """The plies of every wall."""
        material = MATERIALS[self.material] if isinstance(self.material, str) else self.material
        walls = dict(self.ply_angles_deg)
        if set(walls) == {ON_EVERY_WALL}:
            return Layup.uniform(material, walls[ON_EVERY_WALL])
        return Layup.by_wall(material, **walls)


def as_ply_angles(value: Any) -> tuple[tuple[str, tuple[float, ...]], ...]:
    """Ply angles of all walls (a sequence of numbers) or wall by wall (a mapping, or pairs), in one form."""
    try:
        if isinstance(value, Mapping):
            pairs = list(value.items())
        elif all(isinstance(entry, (int, float, np.number)) for entry in value):
            pairs = [(ON_EVERY_WALL, value)]
        else:
            pairs = [(wall, angles) for wall, angles in value]
        return tuple((str(wall), tuple(float(angle) for angle in angles)) for wall, angles in pairs)
    except (TypeError, ValueError):
        raise ValueError(f"ply_angles_deg = {value!r} must be a list of angles, or such a list for each wall.") from None


@dataclass(frozen=True, slots=True)
class BladeConfig:
    """A rotating blade with its patches and electronics: everything a plant is built from."""

    beam: BeamConfig = field(default_factory=BeamConfig)
    patches: PatchLayout = field(default_factory=PatchLayout)
    speed: float = 200.0
    """rad/s."""
    modes: int = 11
    """Retained modes: what a pretwisted blade's tip displacement and voltages need (thesis Fig. 5.2)."""
    gyroscopic: bool = True
    damping_ratio: float = 0.01
    """Of every mode."""
    effort_weight: float = 0.5
    """ρ in R = ρ FᵀK⁻¹F: with ½, uᵀRu is the energy (J) that the actuators store in the blade at rest."""
    white_load: float = 3.0
    """N/m: standard deviation, in lag and in flap, of the white line load of each interval; a tenth of the reference load."""
    sensor_noise_fraction: float = 0.02
    """Standard deviation of one sample over the sensors' full scale."""
    sensor_full_scale: float | None = None
    """A: the range of the data acquisition, and with it its noise, where patches move but the instrument stays; None fits it to
    the blade's largest current after a sudden reference load."""
    voltage_limits: tuple[float, float] = (-1500.0, 1500.0)
    """V, as in the thesis; the data sheet of the MFC has −500 … 1500 V."""
    control_interval: float = 0.5e-3
    """s: 1.4 rad, or between four and five samples a period, of the eleventh mode (2.7 krad/s)."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "voltage_limits", tuple(float(limit) for limit in self.voltage_limits))
        check(self, "effort_weight", allowed="a positive number", valid=lambda value: value > 0.0)
        check(self, "control_interval", allowed="from 1e-6 to 1 s", valid=lambda value: 1e-6 <= value <= 1.0)
        check(
            self,
            "white_load",
            "sensor_noise_fraction",
            "speed",
            allowed="zero or a positive number",
            valid=lambda value: value >= 0.0,
        )
        check(self, "damping_ratio", allowed="at least 0 and below 1", valid=lambda value: 0.0 <= value < 1.0)
        if self.sensor_full_scale is not None:
            check(self, "sensor_full_scale", allowed="None or a positive number", valid=lambda value: value > 0.0)
        low, high = self.voltage_limits
        if not (np.isfinite(low) and np.isfinite(high) and low < 0.0 < high):
            raise ValueError(f"voltage_limits = {self.voltage_limits!r} must be a negative and a positive number of volts.")


def check(config: Any, *names: str, allowed: str, valid: Any) -> None:
    """``ValueError`` naming the field, its value and what is allowed."""
    for name in names:
        value = getattr(config, name)
        if not (isinstance(value, (int, float, np.number)) and np.isfinite(value) and valid(value)):
            raise ValueError(f"{name} = {value!r} must be {allowed}.")


def changed(config: Any, changes: Mapping[str, Any], name: str) -> Any:
    """A copy of a frozen dataclass with the given fields changed, nested mappings reaching into nested dataclasses."""
    if not isinstance(changes, Mapping):
        raise ValueError(f"{name} = {changes!r} must be a mapping of field names to values.")
    known = [entry.name for entry in fields(config)]
    unknown = [key for key in changes if key not in known]
    if unknown:
        raise ValueError(f"{name} has no field {unknown[0]!r}; it has {', '.join(known)}.")
    values = {}
    for key, value in changes.items():
        current = getattr(config, key)
        if is_dataclass(current) and not isinstance(current, Lamina) and not isinstance(value, (Mapping, type(current))):
            raise ValueError(f"{name}.{key} = {value!r} must be a mapping of field names to values.")
        nested = is_dataclass(current) and isinstance(value, Mapping) and not isinstance(current, Lamina)
        values[key] = changed(current, value, f"{name}.{key}") if nested else value
    return replace(config, **values)
