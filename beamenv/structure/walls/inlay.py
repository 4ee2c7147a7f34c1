"""Foreign material in or on a wall, and the strip of the contour that it covers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Flag, Number, Text, configuration
from beamenv.structure.walls.laminate import Laminate, Ply

Array = NDArray[np.float64]

FACES = ("outer", "inner")
"""Of a wall: outside a closed contour, and inside; right and left of one that runs along its tangent."""

FACE = Choice(FACES)


@dataclass(frozen=True, slots=True)
class Strip:
    """What one kind of inlay covers of a wall's contour, wherever along the span."""

    wall: str
    width: float
    """m along the contour."""
    offset: float = 0.0
    """m from the middle of the wall to that of the strip, along the contour, at the root; elsewhere as the section's size is."""


@configuration("inlay")
class Inlay:
    """A rectangle of foreign material, let into a face of a wall and flush with it, or bonded onto it."""

    wall: Annotated[str, Text()]
    start: Annotated[float, Number(unit="m")]
    """Root-side edge, m from the clamp."""
    length: Annotated[float, Number(unit="m")]
    """m along the span."""
    width: Annotated[float, Number(unit="m")]
    """m along the contour."""
    ply: Ply
    """Material and fibre angle."""
    thickness: Annotated[float, Number(unit="m")]
    """m."""
    offset: Annotated[float, Number(unit="m")] = 0.0
    """m along the contour from the wall's middle to the inlay's, at the root."""
    face: Annotated[str, FACE] = "outer"
    """"outer", or "inner": the other side of the wall."""
    bonded: Annotated[bool, Flag()] = False
    """Whether it lies on the face; else it takes the place of what was there."""

    @property
    def strip(self) -> Strip:
        """Where it lies along the contour."""
        return Strip(self.wall, self.width, self.offset)

    @property
    def kind(self) -> tuple[Strip, Ply, float, str, bool]:
        """What inlays that differ only in where they lie along the span have in common."""
        return self.strip, self.ply, self.thickness, self.face, self.bonded

    def covers(self, z: Array) -> NDArray[np.bool_]:
        """Which stations (m from the clamp) lie inside the inlay."""
        return (z > self.start) & (z < self.start + self.length)

    def depths(self, wall_thickness: float) -> tuple[float, float]:
        """Between which distances (m) from the mid-line it lies, in the direction of the outer face."""
        inner = 0.5 * wall_thickness - (0.0 if self.bonded else self.thickness)
        outer = inner + self.thickness if self.bonded else 0.5 * wall_thickness
        return (inner, outer) if self.face == "outer" else (-outer, -inner)

    def let_into(self, laminate: Laminate) -> Laminate:
        """The wall with the inlay."""
        if self.face == "inner":
            return self._outside(laminate.turned_over).turned_over
        return self._outside(laminate)

    def _outside(self, laminate: Laminate) -> Laminate:
        if self.bonded:
            return laminate.with_layer_on_top(self.ply, self.thickness)
        return laminate.with_outer_layer(self.ply, self.thickness)


@dataclass(frozen=True, slots=True)
class Edge:
    """A straight piece of a wall."""

    wall: str
    strips: frozenset[Strip]
    """Those that cover it."""

    def lies_under(self, inlay: Inlay) -> bool:
        """Whether the inlay spans this piece of its wall."""
        return inlay.strip in self.strips
