"""A group of patches: of one sheet and one size, on one wall, at positions along the span."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from beamenv.configuration import Choice, Flag, Number, Patches, Refused, Text, configuration
from beamenv.configuration.numbers import DEGREES
from beamenv.configuration.sentence import in_millimetres
from beamenv.patches.material import FIBRE_ANGLE_DEG, PATCH_MATERIALS, PatchMaterial
from beamenv.structure.sizes import SPAN, WIDTH
from beamenv.structure.walls.inlay import FACE, Inlay

Positions = tuple[float, ...]


@configuration("blade.patches.group")
class PatchGroup:
    """Patches of one kind: where they are, what they are made of, and how they are driven.

    Raises ``ValueError`` for a value that is not allowed; whether they fit the blade shows when they are put on one.
    """

    positions: Annotated[int | Positions, Patches()] = 1
    """Root-side edges, m from the root, or a number of patches to be spaced equally over 0 … ``outermost``."""
    material: Annotated[str | PatchMaterial, Choice(PATCH_MATERIALS, PatchMaterial)] = "MFC"
    """A name or a sheet; in a dictionary or file also a table of a sheet's fields, which completes from the one before."""
    length: Annotated[float, SPAN] = 0.085
    """m along the span: the active area of an M-8557-P1."""
    width: Annotated[float, WIDTH] = 0.057
    """m along the contour."""
    wall: Annotated[str, Text()] = "top"
    face: Annotated[str, FACE] = "outer"
    """"outer" or "inner": of an open section's wall the right or the left, seen along it; a strip's upper or lower."""
    offset: Annotated[float, Number(unit="m")] = 0.0
    """m along the contour, from the middle of the wall to that of the patches, at the root."""
    angle_deg: Annotated[float, DEGREES] = FIBRE_ANGLE_DEG
    """Of the sheet's axis 1, an MFC's fibres, from the contour tangent: 90 is along the span, 45 twists."""
    bonded: Annotated[bool, Flag()] = False
    """Whether they lie on the face, and not in the wall, flush with it."""
    passive: Annotated[bool, Flag()] = True
    """Whether the patches' own mass and stiffness count."""
    ganged: Annotated[bool, Flag()] = False
    """One voltage for all of them instead of one each; of sensors one current."""
    outermost: Annotated[float, Number(gt=0.0, le=1.0)] = 1.0
    """Share of the span that they keep within."""

    @property
    def patch(self) -> PatchMaterial:
        """The sheet the patches are cut from."""
        return PATCH_MATERIALS[self.material] if isinstance(self.material, str) else self.material

    def at(self, name: str, beam_length: float) -> Positions:
        """Root-side edges in m, equally spaced where only a number is given; ``ValueError`` that calls them by ``name`` where they
        overlap or leave the span that is theirs.
        """
        last = self.outermost * beam_length - self.length
        tolerance = 1e-9 * beam_length
        if last < 0.0:
            meant = in_millimetres(self.length, self.outermost * beam_length)
            raise Refused("blade.patches.length", self.length, f"at most {self.outermost} of the {beam_length:.6g} m span", meant)
        patches = self.positions
        apart = f"at least one patch length, {self.length:.6g} m, apart so that patches do not overlap"
        if isinstance(patches, int) and (patches - 1) * (self.length - tolerance) > last:  # before as many numbers are made
            raise Refused(f"blade.patches.{name}", patches, apart)
        positions = tuple(np.linspace(0.0, last, patches).tolist()) if isinstance(patches, int) else patches
        if min(positions) < -tolerance or max(positions) > last + tolerance:
            allowed = (
                f"root-side edges between 0 and {last:.6g} m, so that each {self.length:.6g} m patch lies within 0 and "
                f"{self.outermost} of the {beam_length:.6g} m span"
            )
            raise Refused(f"blade.patches.{name}", patches, allowed)
        if len(positions) > 1 and np.diff(np.sort(positions)).min() < self.length - tolerance:
            raise Refused(f"blade.patches.{name}", patches, apart)
        return tuple(min(max(position, 0.0), last) for position in positions)  # what rounding has moved out of bounds lies on them

    def inlays(self, name: str, beam_length: float) -> tuple[Inlay, ...]:
        """The patches as foreign material, whether or not that counts."""
        return tuple(self.inlay(start, self.length) for start in self.at(name, beam_length))

    def inlay(self, start: float, length: float) -> Inlay:
        """A patch of the group, from ``start`` (m) and ``length`` (m) long, as foreign material."""
        where = self.offset, self.face, self.bonded, self.angle_deg
        return self.patch.inlay(self.wall, start, length, self.width, *where)

    @property
    def count(self) -> int:
        """How many patches."""
        return self.positions if isinstance(self.positions, int) else len(self.positions)

    @property
    def channels(self) -> int:
        """How many voltages or currents."""
        return 1 if self.ganged else self.count
