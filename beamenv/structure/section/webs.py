"""Webs: straight walls across a closed contour, which make cells of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Refused, Text, configuration
from beamenv.structure.walls.chain import Chain

Array = NDArray[np.float64]


@configuration("web")
class Web:
    """A straight wall across a section, from one wall to the opposite one; its tangent runs up, its outer face is on the right."""

    position: Annotated[float, Number(gt=0.0, lt=1.0)]
    """Where its mid-line passes the height of the contour's middle, over the contour's width, from the left."""
    name: Annotated[str, Text(line=True)] = "web"
    tilt_deg: Annotated[float, Number(ge=-90.0, le=90.0, unit="degrees")] = 0.0
    """From upright, its upper end to the right."""


def web_chains(webs: Sequence[Web], contour: Chain, thickness: dict[str, float], usual: float) -> tuple[Chain, ...]:
    """The webs, from mid-line to mid-line; ``ValueError`` for one that does not cross the contour twice, or crosses another."""
    chains = tuple(_chain(web, k, contour, thickness.get(web.name, usual)) for k, web in enumerate(webs))
    for k, one in enumerate(chains):
        for other in chains[:k]:
            if _cross(one.points, other.points):
                raise Refused(f"webs[{k}].position", webs[k].position, "one at which it crosses no other web")
    return chains


def _chain(web: Web, number: int, contour: Chain, thickness: float) -> Chain:
    low, high = contour.points.min(axis=0), contour.points.max(axis=0)
    through = np.array([low[0] + web.position * (high[0] - low[0]), 0.5 * (low[1] + high[1])])
    tilt = np.radians(web.tilt_deg)
    direction = np.array([np.sin(tilt), np.cos(tilt)])
    reached = _crossings(contour, through, direction)
    if len(reached) != 2:
        raise Refused(
            f"webs[{number}].position", web.position, f"one at which {web.name!r} ends on two walls, not on {len(reached)}"
        )
    return Chain(through + np.sort(reached)[:, None] * direction, (web.name,), (thickness,), closed=False)


def _crossings(contour: Chain, through: Array, direction: Array) -> Array:
    """(k,), m along a straight line: where it crosses a contour."""
    step, offset = contour.ends - contour.starts, contour.starts - through
    across = np.array([direction[1], -direction[0]])
    side = np.where(np.abs(offset @ across) < 1e-12 * np.abs(contour.points).max(), 0.0, offset @ across)
    following = np.roll(side, -1)
    crossed = np.flatnonzero((side >= 0.0) != (following >= 0.0))
    share = side[crossed] / (side[crossed] - following[crossed])
    return np.asarray((offset[crossed] + share[:, None] * step[crossed]) @ direction)


def _cross(one: Array, other: Array) -> bool:
    """Whether two straight lines (2, 2) cross or touch."""

    def sides(line: Array, points: Array) -> Array:
        along, to = line[1] - line[0], points - line[0]
        return np.asarray(along[0] * to[:, 1] - along[1] * to[:, 0])

    return bool(np.prod(sides(one, other)) <= 0.0 and np.prod(sides(other, one)) <= 0.0)
