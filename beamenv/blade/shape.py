"""The shape of a blade in space: any section, pretwisted, tapered and displaced along the span, and patches on its walls.

Coordinates are lag, flap and span, in m. Everything that draws a blade draws what stands here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import RotatingBeam
from beamenv.structure.section.section import Section
from beamenv.structure.walls.chain import Chain
from beamenv.structure.walls.contour import rotated
from beamenv.structure.walls.inlay import Inlay

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

SHARP = np.radians(30.0)
"""Corners at which a contour turns by more are drawn as edges."""


@dataclass(frozen=True, slots=True, eq=False)
class Skin:
    """Points of the section followed along the span, at S stations."""

    span: Array
    """(S,), m from the root."""
    points: Array
    """(S, P, 2), m: along the chord and across it."""
    angle: Array
    """(S,), rad: of the chord from the plane of rotation."""

    def at_rest(self) -> Array:
        """(S, P, 3), m."""
        return self.displaced(np.zeros((3, len(self.span))))

    def displaced(self, displacement: Array) -> Array:
        """(…, S, P, 3), m, under displacements (…, 3, S): lag and flap in m, twist in rad."""
        lag, flap, twist = np.moveaxis(displacement, -2, 0)
        across = rotated(self.points, self.angle + twist) + np.stack([lag, flap], axis=-1)[..., None, :]
        along = np.broadcast_to(self.span[:, None, None], (*across.shape[:-1], 1))
        return np.concatenate([across, along], axis=-1)


def body(beam: RotatingBeam, span: Array) -> Skin:
    """The outline of the blade at stations ``span`` (S,), m from the root, or of its first walls; see ``bodies``."""
    return bodies(beam, span)[0]


def bodies(beam: RotatingBeam, span: Array) -> tuple[Skin, ...]:
    """What is seen of the blade at stations ``span`` (S,), m from the root: the outer contour, K corners counter-clockwise; of an
    open section the outline of each of its chains of walls.
    """
    size, angle = beam.planform.scale(span), beam.planform.angle(span)
    return tuple(Skin(span, outline(chain, size), angle) for chain in _seen(beam.section))


def _seen(section: Section) -> tuple[Chain, ...]:
    return section.chains[:1] if section.closed else section.chains


def patch(beam: RotatingBeam, inlay: Inlay, span: Array, raised: float = 0.0) -> Skin:
    """The two edges of an inlay's strip, ``raised`` (m) above the wall's face; above all of a curved wall that lies between them.

    Raises ``ValueError`` for a wall that the section has not in one part.
    """
    section, size = beam.section, beam.planform.scale(span)
    section.wall_width(inlay.wall)
    chain = next(each for each in section.chains if each.part(inlay.wall) is not None)
    first, last = chain.part(inlay.wall) or (0, 0)
    line = np.concatenate([chain.starts[first:last], chain.ends[last - 1 : last]])
    arcs = np.append(0.0, np.cumsum(chain.lengths[first:last]))
    middle, half = 0.5 * arcs[-1] + inlay.offset, 0.5 * inlay.width / size
    ends = np.stack([_along(line, arcs, middle + side * half) for side in (1.0, -1.0)], axis=1)
    across = ends[:, 0] - ends[:, 1]
    across /= np.linalg.norm(across, axis=-1)[:, None]
    side = 1.0 if inlay.face == "outer" else -1.0
    normal = side * np.stack([across[:, 1], -across[:, 0]], axis=-1)
    between = (np.abs(arcs - middle) < half[:, None])[..., None] * (line - ends[:, 1:])
    bulge = np.maximum((between * normal[:, None]).sum(axis=-1).max(axis=1), 0.0)
    height = size * bulge + 0.5 * section.thickness_of(inlay.wall) + raised
    points = size[:, None, None] * ends + (height[:, None] * normal)[:, None]
    return Skin(span, points if inlay.face == "outer" else points[:, ::-1], beam.planform.angle(span))


def _along(line: Array, arcs: Array, at: Array) -> Array:
    """(k, 2): places at distances (k,) along a line of points."""
    return np.stack([np.interp(at, arcs, line[:, axis]) for axis in range(2)], axis=-1)


def outline(chain: Chain, size: Array) -> Array:
    """(S, K, 2), m: the mid-line ``size`` (S,) times as large, and half the wall's thickness outside it; of an open one both faces,
    there and back.
    """
    directions = (chain.ends - chain.starts) / chain.lengths[:, None]
    normals = np.stack([directions[:, 1], -directions[:, 0]], axis=-1)
    half = 0.5 * np.array(chain.thickness)
    if chain.closed:
        before, thin = np.roll(normals, 1, axis=0), np.roll(half, 1)
    else:
        normals, before = np.append(normals, normals[-1:], axis=0), np.append(normals[:1], normals, axis=0)
        half, thin = np.append(half, half[-1]), np.append(half[0], half)
    mitre = (before + normals) / np.maximum(1.0 + (before * normals).sum(axis=-1), 0.5)[:, None]  # no spike at a sharp edge
    middle, away = size[:, None, None] * chain.points, (0.5 * (half + thin))[:, None] * mitre
    return np.asarray(middle + away if chain.closed else np.concatenate([middle + away, (middle - away)[:, ::-1]], axis=1))


def edges(section: Section) -> tuple[Indices, ...]:
    """The corners of each of ``bodies`` that are drawn as edges: the sharp ones; of a round section the outermost each way."""
    contours = [chain.points if chain.closed else outline(chain, np.ones(1))[0] for chain in _seen(section)]
    return tuple(map(_edges, contours))


def _edges(vertices: Array) -> Indices:
    following = np.roll(vertices, -1, axis=0) - vertices
    heading = np.arctan2(following[:, 1], following[:, 0])
    turn = (heading - np.roll(heading, 1) + np.pi) % (2.0 * np.pi) - np.pi
    sharp = np.flatnonzero(np.abs(turn) > SHARP)
    outermost = [*vertices.argmax(axis=0), *vertices.argmin(axis=0)]
    return sharp if len(sharp) else np.unique(outermost)


def sides(walls: Array) -> Array:
    """((S − 1) K, 4, 3): the faces between the stations of walls (S, K, 3), station by station, counter-clockwise from outside."""
    following = np.roll(walls, -1, axis=1)
    return np.stack([following[:-1], following[1:], walls[1:], walls[:-1]], axis=2).reshape(-1, 4, 3)


def quadrilaterals(strips: Array) -> Array:
    """(…, 4, 3): the corners of strips (…, S, 2, 3) from their first station to their last, counter-clockwise from outside."""
    return np.stack([strips[..., 0, 0, :], strips[..., -1, 0, :], strips[..., -1, 1, :], strips[..., 0, 1, :]], axis=-2)


def side_triangles(stations: int, points: int, closed: bool) -> Indices:
    """(k, 3): the surface between points followed along the span; vertices are numbered station by station. In a ``closed``
    contour the last point is joined to the first.
    """
    s, p = np.meshgrid(np.arange(stations - 1), np.arange(points if closed else points - 1), indexing="ij")
    a, b = (s * points + p).ravel(), (s * points + (p + 1) % points).ravel()
    return np.concatenate([np.stack([a, b, a + points], axis=1), np.stack([b, b + points, a + points], axis=1)])


def end_triangles(contour: Array) -> Indices:
    """(K − 2, 3): a contour (K, 2), counter-clockwise and perhaps hollow, cut into triangles ear by ear."""
    left, found = list(range(len(contour))), []
    while len(left) > 3:
        ear = next((k for k in range(1, len(left) - 1) if _is_ear(contour, left, k)), 1)
        found.append(left[ear - 1 : ear + 2])
        del left[ear]
    return np.array([*found, left], dtype=np.intp)


def _is_ear(contour: Array, left: list[int], k: int) -> bool:
    a, b, c = (contour[left[place]] for place in (k - 1, k, k + 1))
    others = contour[[index for index in left if index not in left[k - 1 : k + 2]]]
    inside = (_area(a, b, others) >= 0.0) & (_area(b, c, others) >= 0.0) & (_area(c, a, others) >= 0.0)
    return bool(_area(a, b, c) > 0.0 and not inside.any())


def _area(a: Array, b: Array, c: Array) -> Array:
    """Twice the area of triangles, positive counter-clockwise."""
    one, other = b - a, c - a
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])


def magnification(deflection: float, drawn: float, digits: Sequence[int] = range(1, 10)) -> float:
    """How many times larger than life a deflection (m) is drawn: a digit times a power of ten, no more than makes it ``drawn`` m.

    1 for a blade that does not move.
    """
    if deflection <= 0.0:
        return 1.0
    wanted = drawn / deflection
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(digit for digit in digits if digit * power <= wanted))
