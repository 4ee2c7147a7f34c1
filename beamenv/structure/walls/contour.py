"""Closed polygonal mid-lines: Gauss points on every edge, at many stations of the span at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.walls.inlay import Edge, Strip

Array = NDArray[np.float64]

GAUSS_POSITIONS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
"""Two points per edge: exact, since every section integrand is at most quadratic along a straight edge."""


@dataclass(frozen=True, slots=True, eq=False)
class WallPoints:
    """Gauss points of a contour at S stations, P = 2K points each, in the directions of the blade's x and y."""

    edges: tuple[Edge, ...]
    x: Array
    y: Array
    l: Array  # noqa: E741 - the field's name for dy/ds
    m: Array
    ds: Array
    """(S, P) each: position (m), outward normal (l, m) and integration weight (m)."""
    along: Array
    """(S, P): distance (m) from the start of the point's edge."""

    @property
    def normal_distance(self) -> Array:
        """r_n = x l + y m (S, P), m: distance of the wall's tangent from the origin."""
        return self.x * self.l + self.y * self.m

    @property
    def tangential_distance(self) -> Array:
        """A = m x − l y (S, P), m."""
        return self.m * self.x - self.l * self.y

    def around(self, values: Array) -> Array:
        """∮ value ds (S, …) of values (S, P, …)."""
        return np.einsum("sp,sp...->s...", self.ds, values)

    def integral_from_start(self, slope: Array) -> Array:
        """∫₀ˢ slope ds at the points (S, P) for a slope that is constant along each edge."""
        edge_length = 2.0 * self.ds[:, ::2]
        per_edge = slope[:, ::2] * edge_length
        start = np.cumsum(per_edge, axis=1) - per_edge
        return np.repeat(start, 2, axis=1) + slope * self.along


def split_walls(vertices: Array, walls: Sequence[str], strips: Sequence[Strip]) -> tuple[Array, tuple[Edge, ...]]:
    """Cut walls where strips in their middle begin and end: vertices (S, K, 2) to (S, K', 2), with what each new edge is."""
    points, edges = [], []
    following = np.roll(vertices, -1, axis=1)
    for k, wall in enumerate(walls):
        start, end = vertices[:, k], following[:, k]
        length = np.hypot(*(end - start).T)[:, None]
        own = [strip for strip in strips if strip.wall == wall]
        halves = sorted({0.5 * strip.width for strip in own})
        cuts = [-half for half in reversed(halves)] + halves
        points += [start, *(0.5 * (start + end) + cut * (end - start) / length for cut in cuts)]
        limits = [-np.inf, *cuts, np.inf]
        reach = [max(abs(a), abs(b)) for a, b in zip(limits[:-1], limits[1:], strict=True)]
        edges += [Edge(wall, frozenset(strip for strip in own if far <= 0.5 * strip.width)) for far in reach]
    return np.stack(points, axis=1), tuple(edges)


def wall_points(vertices: Array, edges: tuple[Edge, ...]) -> WallPoints:
    """Gauss points on the closed polygon with the given vertices (S, K, 2), counter-clockwise."""
    step = np.roll(vertices, -1, axis=1) - vertices
    length = np.hypot(step[..., 0], step[..., 1])
    # An inlay as wide as its wall leaves edges of no length on both sides: no weight, any direction.
    direction = step / np.where(length > 0.0, length, 1.0)[..., None]
    points = (vertices[:, :, None, :] + GAUSS_POSITIONS[:, None] * step[:, :, None, :]).reshape(len(vertices), -1, 2)
    return WallPoints(
        edges=edges,
        x=points[..., 0],
        y=points[..., 1],
        l=np.repeat(direction[..., 1], 2, axis=1),
        m=np.repeat(-direction[..., 0], 2, axis=1),
        ds=np.repeat(0.5 * length, 2, axis=1),
        along=(length[:, :, None] * GAUSS_POSITIONS).reshape(len(vertices), -1),
    )


def meets_itself(vertices: Array) -> bool:
    """Whether the edges of a closed polygon (K, 2) cross, touch or lie on one another anywhere but at the corners they share."""
    start, end = vertices, np.roll(vertices, -1, axis=0)
    count = len(vertices)
    one, other = np.triu_indices(count, 1)

    def side(of: NDArray[np.intp], points: Array) -> Array:
        """Where points lie: left of an edge (1), right of it (−1), or in line with it within rounding (0)."""
        along, to = (end - start)[of], points - start[of]
        turned = along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]
        return np.where(np.abs(turned) <= 1e-12 * np.hypot(*along.T) * np.hypot(*to.T), 0.0, np.sign(turned))

    def within(of: NDArray[np.intp], points: Array) -> NDArray[np.bool_]:
        """Whether points in line with an edge lie on it."""
        along, to = (end - start)[of], points - start[of]
        share = (along * to).sum(axis=1) / (along**2).sum(axis=1)
        return (share >= 0.0) & (share <= 1.0)

    sides = [side(one, start[other]), side(one, end[other]), side(other, start[one]), side(other, end[one])]
    ends = [(one, start[other]), (one, end[other]), (other, start[one]), (other, end[one])]
    crosses = (sides[0] * sides[1] < 0.0) & (sides[2] * sides[3] < 0.0)
    touches = [(each == 0.0) & within(of, points) for each, (of, points) in zip(sides, ends, strict=True)]
    follows, closes = other == one + 1, (one == 0) & (other == count - 1)
    # neighbours share a corner; their other ends may not lie on one another
    apart = [~(follows & (k in (0, 3))) & ~(closes & (k in (1, 2))) for k in range(4)]
    return bool(np.any(crosses | np.any([touch & free for touch, free in zip(touches, apart, strict=True)], axis=0)))


def rotated(vertices: Array, angle: Array) -> Array:
    """Vertices (S, K, 2) turned about the span by the angle (S,) in rad (thesis Eq. 2.38)."""
    c, s = np.cos(angle), np.sin(angle)
    return vertices @ np.stack([np.stack([c, s], axis=-1), np.stack([-s, c], axis=-1)], axis=-2)
