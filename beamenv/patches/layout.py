"""Where the patches are: actuators in the top wall, sensors in the bottom wall."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from beamenv.configuration import Choice, Flag, Number, Patches, Refused, checked, configuration
from beamenv.patches.material import PATCH_MATERIALS, PatchMaterial
from beamenv.structure.walls.inlay import Inlay

ACTUATOR_WALL, SENSOR_WALL = "top", "bottom"

OUTERMOST = 0.7
"""Patches lie between the root and this share of the span: nearer the tip they act as added mass (thesis §5.5)."""


@configuration("blade.patches")
class PatchLayout:
    """Patches of one kind: root-side edges in m from the root, or a number of patches to be spaced equally over 0 … 0.7 L."""

    actuators: Annotated[int | tuple[float, ...], Patches()] = 4
    sensors: Annotated[int | tuple[float, ...], Patches()] = 4
    material: Annotated[str, Choice(tuple(PATCH_MATERIALS))] = "MFC"
    length: Annotated[float, Number(gt=0.0, unit="m")] = 0.085
    """m along the span: the active area of an M-8557-P1."""
    width: Annotated[float, Number(gt=0.0, unit="m")] = 0.057
    """m across."""
    passive: Annotated[bool, Flag()] = True
    """Whether the patches' own mass and stiffness count."""
    ganged: Annotated[bool, Flag()] = False
    """One voltage for all actuators (the thesis' first method) instead of one each (its second)."""

    @property
    def patch(self) -> PatchMaterial:
        """The sheet the patches are cut from."""
        return PATCH_MATERIALS[self.material]

    def actuator_positions(self, beam_length: float) -> tuple[float, ...]:
        """Root-side edges in m; ``ValueError`` if patches overlap or leave 0 … 0.7 L."""
        return spaced("actuators", self.actuators, self.length, _span(beam_length))

    def sensor_positions(self, beam_length: float) -> tuple[float, ...]:
        """Root-side edges in m; ``ValueError`` if patches overlap or leave 0 … 0.7 L."""
        return spaced("sensors", self.sensors, self.length, _span(beam_length))

    def inlays(self, beam_length: float) -> tuple[Inlay, ...]:
        """The patches as foreign material in the walls; none when they are not passive."""
        return (*self.actuator_inlays(beam_length), *self.sensor_inlays(beam_length)) if self.passive else ()

    def actuator_inlays(self, beam_length: float) -> tuple[Inlay, ...]:
        """The actuators as foreign material, whether or not that counts."""
        return self._inlays(ACTUATOR_WALL, self.actuator_positions(beam_length))

    def sensor_inlays(self, beam_length: float) -> tuple[Inlay, ...]:
        """The sensors as foreign material, whether or not that counts."""
        return self._inlays(SENSOR_WALL, self.sensor_positions(beam_length))

    def _inlays(self, wall: str, starts: tuple[float, ...]) -> tuple[Inlay, ...]:
        return tuple(self.patch.inlay(wall, start, self.length, self.width) for start in starts)


def _span(beam_length: float) -> float:
    span: float = checked("beam_length", beam_length, Number(gt=0.0, unit="m"))
    return span


def spaced(name: str, patches: int | tuple[float, ...], length: float, beam_length: float) -> tuple[float, ...]:
    """Positions in m, equally spaced where only a number is given, checked against the blade and each other."""
    last = OUTERMOST * beam_length - length
    tolerance = 1e-9 * beam_length
    if last < 0.0:
        raise Refused("blade.patches.length", length, f"at most {OUTERMOST} of the {beam_length:.6g} m span")
    apart = f"at least one patch length, {length:.6g} m, apart so that patches do not overlap"
    if isinstance(patches, int) and (patches - 1) * (length - tolerance) > last:  # before as many numbers are made
        raise Refused(f"blade.patches.{name}", patches, apart)
    positions = tuple(np.linspace(0.0, last, patches).tolist()) if isinstance(patches, int) else patches
    if min(positions) < -tolerance or max(positions) > last + tolerance:
        allowed = (
            f"root-side edges between 0 and {last:.6g} m, so that each {length:.6g} m patch lies within 0 and {OUTERMOST} of the "
            f"{beam_length:.6g} m span"
        )
        raise Refused(f"blade.patches.{name}", patches, allowed)
    if len(positions) > 1 and np.diff(np.sort(positions)).min() < length - tolerance:
        raise Refused(f"blade.patches.{name}", patches, apart)
    return tuple(min(max(position, 0.0), last) for position in positions)  # what rounding has moved out of bounds lies on them
