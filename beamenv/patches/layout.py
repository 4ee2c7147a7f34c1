"""Where the patches are: actuators in the top wall, sensors in the bottom wall."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamenv.patches.material import PATCH_MATERIALS, PatchMaterial
from beamenv.structure.checks import is_number
from beamenv.structure.walls.contour import Inlay

ACTUATOR_WALL, SENSOR_WALL = "top", "bottom"

OUTERMOST = 0.7
"""Patches lie between the root and this share of the span: nearer the tip they act as added mass (thesis §5.5)."""


@dataclass(frozen=True, slots=True)
class PatchLayout:
    """Patches of one kind: root-side edges in m from the root, or a number of patches to be spaced equally over 0 … 0.7 L."""

    actuators: int | tuple[float, ...] = 4
    sensors: int | tuple[float, ...] = 4
    material: str = "MFC"
    length: float = 0.085
    """m along the span: the active area of an M-8557-P1."""
    width: float = 0.057
    """m across."""
    passive: bool = True
    """Whether the patches' own mass and stiffness count."""
    ganged: bool = False
    """One voltage for all actuators (the thesis' first method) instead of one each (its second)."""

    def __post_init__(self) -> None:
        if self.material not in PATCH_MATERIALS:
            raise ValueError(f"material = {self.material!r} of the patches must be one of {', '.join(PATCH_MATERIALS)}.")
        for name in ("length", "width"):
            if not (is_number(getattr(self, name)) and getattr(self, name) > 0.0):
                raise ValueError(f"{name} = {getattr(self, name)!r} of the patches must be a positive number of metres.")
        for name in ("actuators", "sensors"):
            object.__setattr__(self, name, as_positions(name, getattr(self, name)))

    @property
    def patch(self) -> PatchMaterial:
        """The sheet the patches are cut from."""
        return PATCH_MATERIALS[self.material]

    def actuator_positions(self, beam_length: float) -> tuple[float, ...]:
        """Root-side edges in m; ``ValueError`` if patches overlap or leave 0 … 0.7 L."""
        return place("actuators", self.actuators, self.length, beam_length)

    def sensor_positions(self, beam_length: float) -> tuple[float, ...]:
        """Root-side edges in m; ``ValueError`` if patches overlap or leave 0 … 0.7 L."""
        return place("sensors", self.sensors, self.length, beam_length)

    def inlays(self, beam_length: float) -> tuple[Inlay, ...]:
        """The patches as foreign material in the walls; none when they are not passive."""
        if not self.passive:
            return ()
        walls = ((ACTUATOR_WALL, self.actuator_positions(beam_length)), (SENSOR_WALL, self.sensor_positions(beam_length)))
        return tuple(self.patch.inlay(wall, start, self.length, self.width) for wall, starts in walls for start in starts)


def as_positions(name: str, value: int | Sequence[float]) -> int | tuple[float, ...]:
    """A number of patches, or their positions as a tuple."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        if value < 1:
            raise ValueError(f"{name} = {value!r} must be at least one patch.")
        return int(value)
    try:
        positions = tuple(float(position) for position in value)  # type: ignore[union-attr]
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {value!r} must be a number of patches or their positions in metres.") from None
    if not positions or not np.all(np.isfinite(positions)):
        raise ValueError(f"{name} = {positions!r} must be one or more finite positions in metres.")
    return positions


def place(name: str, patches: int | tuple[float, ...], length: float, beam_length: float) -> tuple[float, ...]:
    """Positions in m, equally spaced where only a number is given, checked against the blade and each other."""
    last = OUTERMOST * beam_length - length
    tolerance = 1e-9 * beam_length
    if last < 0.0:
        raise ValueError(f"length = {length!r} of the patches must be at most {OUTERMOST} of the {beam_length:.6g} m span.")
    positions = tuple(np.linspace(0.0, last, patches).tolist()) if isinstance(patches, int) else patches
    if min(positions) < -tolerance or max(positions) > last + tolerance:
        raise ValueError(
            f"{name} = {patches!r} must have their root-side edges between 0 and {last:.6g} m "
            f"so that each {length:.6g} m patch lies within 0 and {OUTERMOST} of the {beam_length:.6g} m span."
        )
    if len(positions) > 1 and np.diff(np.sort(positions)).min() < length - tolerance:
        raise ValueError(
            f"{name} = {patches!r} must be at least one patch length, {length:.6g} m, apart so that patches do not overlap."
        )
    return positions
