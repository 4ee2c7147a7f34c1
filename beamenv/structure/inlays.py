"""Whether inlays fit a beam."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from beamenv.configuration import Refused
from beamenv.configuration.near import meant
from beamenv.structure.section.section import Section
from beamenv.structure.walls.inlay import Inlay

SHORTEST = 1e-9
"""Of the span: what lies closer together is in one place."""

ROUNDING = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """What a beam has for inlays."""

    section: Section
    length: float
    """m."""
    narrowest: float
    """Size of the section where it is smallest, over that at the root, or 1."""
    thesis: bool
    """Whether it is in the thesis' model, which has inlays in the middle of straight walls' outer faces alone."""

    def check(self, inlays: Sequence[Inlay]) -> None:
        """``ValueError`` for inlays that do not fit their wall or overlap."""
        for inlay in inlays:
            self.check_fit(inlay)
        for first, second in combinations(sorted(inlays, key=lambda inlay: inlay.start), 2):
            if self._overlap(first, second):
                raise ValueError(
                    f"inlays at {first.start!r} and {second.start!r} m on the {first.wall} wall must be {first.length!r} m apart."
                )

    def check_fit(self, inlay: Inlay) -> None:
        """``ValueError`` for an inlay that leaves the beam, is as thick as its wall or wider than it at the narrow end."""
        end = inlay.start + inlay.length
        if not (inlay.start >= 0.0 and end <= self.length * (1.0 + ROUNDING)):
            raise Refused("inlay.start", inlay.start, f"0 at least, and its end, {end!r}, on the blade, 0 to {self.length!r} m")
        if not inlay.length > SHORTEST * self.length:
            raise Refused("inlay.length", inlay.length, f"above {SHORTEST * self.length:.3g} (m)")
        self._check_contour(inlay)
        thickness = self.section.thickness_of(inlay.wall)
        if not (inlay.thickness > 0.0 and (inlay.bonded or inlay.thickness < thickness)):
            raise Refused("inlay.thickness", inlay.thickness, f"positive and below the wall's {thickness!r} m, or bonded onto it")
        if self.thesis and (inlay.offset or inlay.bonded or inlay.face != "outer"):
            name = "offset" if inlay.offset else "bonded" if inlay.bonded else "face"
            said = "of one let into the outer face in the middle of its wall with model = 'thesis'"
            raise Refused(f"inlay.{name}", getattr(inlay, name), said)

    def _overlap(self, first: Inlay, second: Inlay) -> bool:
        """Whether two inlays, the second no nearer to the root, take the same place."""
        apart = second.start >= first.start + first.length - SHORTEST * self.length
        if apart or (first.wall, first.face) != (second.wall, second.face):
            return False
        return abs(first.offset - second.offset) < 0.5 * (first.width + second.width) * (1.0 - SHORTEST)

    def _check_contour(self, inlay: Inlay) -> None:
        """``ValueError`` where an inlay does not fit its wall along the contour."""
        section = self.section
        if self.thesis and section.walls.count(inlay.wall) != 1:
            allowed = f"one straight wall of the section: {', '.join(section.wall_names)}"
            raise Refused("inlay.wall", inlay.wall, allowed, meant(inlay.wall, section.wall_names))
        try:
            width = section.wall_width(inlay.wall)
        except Refused as refused:
            raise Refused(f"inlay.{refused.name}", refused.value, refused.allowed, refused.meant) from None
        room = self.narrowest * max(width - 2.0 * abs(inlay.offset), 0.0)
        if not 0.0 < inlay.width <= room * (1.0 + ROUNDING):
            where = f" (offset {inlay.offset!r} m from its middle)" if inlay.offset else ""
            raise Refused("inlay.width", inlay.width, f"positive and at most the {inlay.wall} wall's {room:.6g} m{where}")
