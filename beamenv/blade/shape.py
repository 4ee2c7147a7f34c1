"""The shape of a blade in space: any closed section, pretwisted, tapered and displaced along the span, and patches on its walls.

Coordinates are lag, flap and span, in m. Everything that draws a blade draws what stands here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import RotatingBeam
from beamenv.structure.section.section import Section
from beamenv.structure.walls.contour import rotated

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
    """The outer contour of the blade at stations ``span`` (S,), m from the root; its K corners run counter-clockwise."""
    return Skin(span, outer_contour(beam.section, beam.planform.scale(span)), beam.planform.angle(span))


def patch(beam: RotatingBeam, wall: str, width: float, span: Array, raised: float = 0.0) -> Skin:
    """The two edges of a strip ``width`` (m) wide in the middle of a wall, ``raised`` (m) above its outer face.

    Raises ``ValueError`` for a wall that is not one straight edge of the section.
    """
    beam.section.wall_width(wall)
    k = beam.section.walls.index(wall)
    vertices, size = beam.section.vertices, beam.planform.scale(span)
    start, end = vertices[k], vertices[(k + 1) % len(vertices)]
    along = (end - start) / np.linalg.norm(end - start)
    middle = size[:, None] * 0.5 * (start + end) + (0.5 * beam.section.thickness + raised) * np.array([along[1], -along[0]])
    return Skin(span, np.stack([middle + 0.5 * width * along, middle - 0.5 * width * along], axis=1), beam.planform.angle(span))


def outer_contour(section: Section, size: Array) -> Array:
    """(S, K, 2), m: the mid-line ``size`` (S,) times as large, and half the wall's thickness outside it."""
    vertices = section.vertices
    following = np.roll(vertices, -1, axis=0) - vertices
    normals = np.stack([following[:, 1], -following[:, 0]], axis=-1) / np.linalg.norm(following, axis=-1)[:, None]
    before = np.roll(normals, 1, axis=0)
    mitre = (before + normals) / np.maximum(1.0 + (before * normals).sum(axis=-1), 0.5)[:, None]  # no spike at a sharp edge
    return np.asarray(size[:, None, None] * vertices + 0.5 * section.thickness * mitre)


def edges(section: Section) -> Indices:
    """The corners of the section that are drawn as edges: the sharp ones; of a round section the outermost in each direction."""
    vertices = section.vertices
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
