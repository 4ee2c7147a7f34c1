"""Whether inlays fit a blade."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from beamenv.configuration import Refused
from beamenv.structure.walls.inlay import Inlay

if TYPE_CHECKING:
    from beamenv.structure.beam import RotatingBeam

SHORTEST = 1e-9
"""Of the span: what lies closer together is in one place."""

ROUNDING = 1e-12


def check_inlays(beam: RotatingBeam) -> None:
    """``ValueError`` for inlays that do not fit their wall or overlap."""
    for inlay in beam.inlays:
        check_fit(beam, inlay)
    for first, second in combinations(sorted(beam.inlays, key=lambda inlay: inlay.start), 2):
        if _overlap(first, second, beam.length):
            raise ValueError(
                f"inlays at {first.start!r} and {second.start!r} m on the {first.wall} wall must be {first.length!r} m apart."
            )


def _overlap(first: Inlay, second: Inlay, length: float) -> bool:
    """Whether two inlays, the second no nearer to the root, take the same place."""
    if (first.wall, first.face) != (second.wall, second.face) or second.start >= first.start + first.length - 1e-9 * length:
        return False
    return abs(first.offset - second.offset) < 0.5 * (first.width + second.width) * (1.0 - 1e-9)


def check_fit(beam: RotatingBeam, inlay: Inlay) -> None:
    """``ValueError`` for an inlay that leaves the blade, is as thick as its wall or wider than it at the narrow end."""
    end = inlay.start + inlay.length
    if not (inlay.start >= 0.0 and end <= beam.length * (1.0 + ROUNDING)):
        raise ValueError(f"inlay from {inlay.start!r} to {end!r} m must lie on the blade, 0 to {beam.length!r} m.")
    if not inlay.length > SHORTEST * beam.length:
        raise ValueError(f"inlay length = {inlay.length!r} m must be above {SHORTEST * beam.length:.3g} m.")
    _check_contour(beam, inlay)
    thickness = beam.section.thickness_of(inlay.wall)
    if not (inlay.thickness > 0.0 and (inlay.bonded or inlay.thickness < thickness)):
        raise ValueError(f"inlay thickness = {inlay.thickness!r} m must be positive and below the wall's {thickness!r} m.")
    if beam.model == "thesis" and (inlay.offset or inlay.bonded or inlay.face != "outer"):
        raise ValueError("inlay must be let into the outer face in the middle of its wall in the thesis' model.")


def _check_contour(beam: RotatingBeam, inlay: Inlay) -> None:
    """``ValueError`` where an inlay does not fit its wall along the contour."""
    section = beam.section
    if beam.model == "thesis" and section.walls.count(inlay.wall) != 1:
        raise Refused("wall", inlay.wall, f"one straight wall of the section: {', '.join(section.wall_names)}")
    scale = beam.narrowest
    room = scale * (section.wall_width(inlay.wall) - 2.0 * abs(inlay.offset))
    if not 0.0 < inlay.width <= room * (1.0 + ROUNDING):
        where = f" (offset {inlay.offset!r} m from its middle)" if inlay.offset else ""
        raise ValueError(
            f"inlay width = {inlay.width!r} m must be positive and at most the {inlay.wall} wall's {room:.6g} m{where}."
        )
