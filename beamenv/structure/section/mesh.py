"""A section as a ring of solid elements: each straight piece of a wall, mitred where walls meet, is one element through it.

Along the contour an element runs from one *line* to the next; a line crosses the wall from its inner to its outer face, along the
normal, or along the mitre at a corner. A point of an element is (1 − t)(P + n d) + t(P′ + n d′) with t in 0 … 1 between the lines
(P, d) and (P′, d′), and n the distance from the mid-line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.configuration.read_only import Sealed
from beamenv.structure.walls.contour import Edge

Array = NDArray[np.float64]

SHARP = np.radians(12.0)
"""Turn of the contour beyond which a corner disturbs the stresses, and elements grow from it."""

CORNER_ELEMENT = 1.0
"""Length of an element beside a sharp corner, in wall thicknesses."""

NARROWEST = 1e-3
"""Of a wall: a strip that leaves less of it on either side is taken to leave this much."""

FEW = 40
"""Elements up to which each has fourth order along the contour; rings of more have second order."""


@dataclass(frozen=True, slots=True, eq=False)
class Ring(Sealed):
    """A closed ring of K elements at S sizes of a section, all of one topology."""

    points: Array
    """P (S, K, 2), m: where line k crosses the mid-line; element k runs from line k to line k + 1."""
    directions: Array
    """d (S, K, 2): along line k, per metre of n."""
    tangents: Array
    """(S, K, 2): unit tangent of element k, counter-clockwise."""
    edges: tuple[Edge, ...]
    """What each element is a piece of."""
    thickness: float
    """m."""

    @property
    def order(self) -> int:
        """Polynomial order along the contour."""
        return 4 if len(self.edges) <= FEW else 2


def ring(vertices: Array, walls: Sequence[str], thickness: float, cuts: Sequence[tuple[str, float]] = ()) -> Ring:
    """The elements of a closed polygon with vertices (S, K, 2), counter-clockwise, cut where a strip (wall, width) in the middle of
    a wall begins and ends.

    Raises ``ValueError`` where a wall is too short for its thickness at the corners.
    """
    step = np.roll(vertices, -1, axis=1) - vertices
    length = np.hypot(step[..., 0], step[..., 1])
    tangent = step / length[..., None]
    slant, intrusion, sharp = _corners(tangent, thickness)
    points, directions, tangents, edges = [], [], [], []
    for k, wall in enumerate(walls):
        ends = [k, (k + 1) % len(walls)]
        grown = _corner_elements(length[:, k], intrusion[:, ends], thickness, wall)
        halves = sorted({0.5 * width for name, width in cuts if name == wall})
        for distance, reach in _lines(length[:, k], grown, sharp[ends], halves):
            share = np.stack([1.0 - distance / grown[:, 0], 1.0 - (length[:, k] - distance) / grown[:, 1]], axis=-1)
            points.append(vertices[:, k] + distance[:, None] * tangent[:, k])
            directions.append(normal_of(tangent[:, k]) + (np.maximum(share, 0.0)[:, None] @ slant[:, ends, k])[:, 0])
            tangents.append(tangent[:, k])
            edges.append(Edge(wall, reach))
    P, d, along = (np.stack(each, axis=1) for each in (points, directions, tangents))
    return Ring(P, d, along, tuple(edges), thickness)


def normal_of(tangent: Array) -> Array:
    """The outward normal (…, 2) of a contour that runs counter-clockwise."""
    return np.stack([tangent[..., 1], -tangent[..., 0]], axis=-1)


def _corners(tangent: Array, thickness: float) -> tuple[Array, Array, NDArray[np.bool_]]:
    """At corner k, between edges k − 1 and k: by how much the mitre departs from the normal of each edge (S, K, K, 2), how far (m)
    it reaches along both walls (S, K), and whether it is sharp (K,).
    """
    normal, before = normal_of(tangent), np.roll(tangent, 1, axis=1)
    cosine = (before * tangent).sum(axis=-1)
    turn = np.arccos(np.clip(cosine, -1.0, 1.0))
    mitre = (normal + np.roll(normal, 1, axis=1)) / (1.0 + cosine)[..., None]
    return mitre[:, :, None] - normal[:, None], 0.5 * thickness * np.tan(0.5 * turn), turn[0] > SHARP


def _corner_elements(length: Array, intrusion: Array, thickness: float, wall: str) -> Array:
    """How far (S, 2), m, the corners at both ends of an edge disturb it; ``ValueError`` where they leave no wall between them."""
    free = length - intrusion.sum(axis=1)
    if np.any(free <= 0.0):
        raise Refused("thickness", thickness, f"small enough that the corners leave some of the {wall} wall between them")
    return np.minimum(np.maximum(CORNER_ELEMENT * thickness, 2.0 * intrusion), intrusion + 0.4 * free[:, None])


def _lines(length: Array, grown: Array, sharp: NDArray[np.bool_], halves: list[float]) -> list[tuple[Array, float]]:
    """Where lines cross one edge, (S,) m from its start, ascending, and the reach (see ``Edge``) of what begins there."""
    whole = bool(halves) and halves[-1] >= 0.5 * length.max() * (1.0 - 1e-9)
    strips, outer = (halves[:-1], halves[-1]) if whole else (halves, np.inf)
    margins = [np.maximum(0.5 * length - half, NARROWEST * length) for half in strips]
    smallest = int(length.argmin())
    room = float(margins[-1][smallest]) if margins else np.inf
    grows = [bool(is_sharp) and room > 1.2 * far for is_sharp, far in zip(sharp, grown[smallest], strict=True)]
    lines = [(np.zeros_like(length), outer)]
    lines += [(grown[:, 0], outer)] if grows[0] else []
    lines += [(margin, half) for margin, half in zip(reversed(margins), reversed(strips), strict=True)]
    lines += [(length - margin, beyond) for margin, beyond in zip(margins, [*strips, outer][1:], strict=True)]
    return lines + ([(length - grown[:, 1], outer)] if grows[1] else [])
