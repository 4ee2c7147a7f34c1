"""Where a blade changes along its span: the places that stations lie between, and those at which trial functions break."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.inlays import SHORTEST
from beamenv.structure.planform import Planform
from beamenv.structure.section.section import Section
from beamenv.structure.walls.inlay import Inlay

Array = NDArray[np.float64]

THICK_INLAY = 0.05
"""Of a wall's thickness: where thicker inlays begin and end strains jump, which polynomials along the span cannot follow. Sheets of
0.3 mm on a strip of 2 mm would move its tip 13 % too far per volt. The thesis' patches are a thirtieth of their walls: left to the
polynomials they move the tip at rest 0.5 to 2.4 % too far per volt, with breaks 0.05 to 0.24 %, and of the first eleven
frequencies none is more than 1.6e-4 off, against finite elements."""

BONDED_SHEET = 0.02
"""The same of sheets on a face, which stiffen bending by some three times that share: wafers of 0.25 mm on a strip of 3 mm
would move its tip 4 % too far per volt with 16 polynomials, and 2 % with 24."""

TOO_CLOSE = 1e-4
"""Of the span: breaks nearer to one another, to the clamp or to the tip are left out, for what lies between is too short to matter:
of two sheets on a strip, six frequencies are as near to finite elements with edges 10⁻⁴ apart as with 3·10⁻³."""


def breaks(section: Section, planform: Planform, inlays: Sequence[Inlay]) -> tuple[float, ...]:
    """Where inlays begin and end that change their walls much, and at corners of tables along the span, m."""
    length = planform.length
    thick = [each for each in inlays if each.thickness > _follows(each) * section.thickness_of(each.wall)]
    edges = breakpoints([*(edge for each in thick for edge in (each.start, each.start + each.length)), *planform.corners], length)
    found = [0.0]
    for edge in edges[1:-1].tolist():
        found += [edge] if edge - found[-1] > TOO_CLOSE * length else []
    return tuple(edge for edge in found[1:] if edge < (1.0 - TOO_CLOSE) * length)


def _follows(inlay: Inlay) -> float:
    """Over the wall's thickness: up to where polynomials along the span follow what an inlay does to strains."""
    return BONDED_SHEET if inlay.bonded else THICK_INLAY


def breakpoints(edges: Sequence[float], length: float) -> Array:
    """Ascending span coordinates (m) of root, tip and the given edges, without repetition."""
    ends = np.unique(np.clip([0.0, *edges, length], 0.0, length))
    return ends[np.append(True, np.diff(ends) > SHORTEST * length)]
