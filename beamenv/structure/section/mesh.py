"""A section as solid elements: each straight piece of a wall, mitred where walls meet, is one element through it.

Along the contour an element runs from one *line* to the next; a line crosses the wall from its inner to its outer face, along the
normal, or along the mitre at a corner, or along the face of the wall that a web ends on. A point of an element is
(1 − t)(P + n d) + t(Q + n e) with t in 0 … 1 between the lines (P, d) and (Q, e), and n the distance from the mid-line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.configuration.read_only import Sealed
from beamenv.structure.section.paths import SHARP, Path, Seat, paths
from beamenv.structure.section.strips import Cut, cut_for
from beamenv.structure.walls.chain import Chain
from beamenv.structure.walls.inlay import Edge, Strip

Array = NDArray[np.float64]

CORNER_ELEMENT = 1.0
"""Length of an element beside a sharp corner or a loose end, in wall thicknesses."""

FEW = 40
"""Elements up to which each has fourth order along the contour; sections of more have second order."""


@dataclass(frozen=True, slots=True)
class Joint:
    """A line that is not its own: it lies along a face of an element."""

    element: int
    side: float
    """1 on the outer face, −1 on the inner."""
    sense: float
    """1 where it runs as the element does, −1 against it."""


@dataclass(frozen=True, slots=True, eq=False)
class Mesh(Sealed):
    """K elements at S sizes of a section, all of one topology."""

    points: Array
    """P (S, K, 2), m: where an element's first line crosses the mid-line."""
    directions: Array
    """d (S, K, 2): along that line, per metre of n."""
    last_points: Array
    last_directions: Array
    """Q, e (S, K, 2): those of its last line."""
    tangents: Array
    """(S, K, 2): unit tangent of element k."""
    thickness: Array
    """(K,), m."""
    edges: tuple[Edge, ...]
    """What each element is a piece of."""
    lines: NDArray[np.intp]
    """(K, 2): which lines an element lies between; from ``count`` on they are joints."""
    count: int
    """How many lines there are, joints aside."""
    joints: tuple[Joint, ...]
    opens: NDArray[np.bool_]
    """(K,): whether an element is of a chain that does not close."""

    def rows(self, rows: NDArray[np.intp]) -> Mesh:
        """The elements at some of the sizes, ascending."""
        if len(rows) == len(self.points):
            return self
        by_size = ("points", "directions", "last_points", "last_directions", "tangents")
        return replace(self, **{name: getattr(self, name)[rows] for name in by_size})

    @property
    def order(self) -> int:
        """Polynomial order along the contour."""
        return 4 if len(self.edges) <= FEW else 2

    @property
    def hosts(self) -> tuple[int, ...]:
        """Elements that have joints."""
        return tuple(sorted({joint.element for joint in self.joints}))

    @property
    def loose_ends(self) -> NDArray[np.intp]:
        """Elements whose last line is no other's first."""
        last = self.lines[:, 1]
        return np.flatnonzero((last < self.count) & ~np.isin(last, self.lines[:, 0]))

    @property
    def open_elements(self) -> NDArray[np.intp]:
        """Elements of chains that do not close."""
        return np.flatnonzero(self.opens)


def mesh(chains: Sequence[Chain], sizes: Array, strips: Sequence[Strip] = (), needed: NDArray[np.bool_] | None = None) -> Mesh:
    """The elements of walls at sizes (S,), cut where strips of them begin and end; where not ``needed`` (S,) they need not fit.

    Raises ``ValueError`` where a wall is too short for its thickness at the corners, and where one cannot end on another.
    """
    fitting = np.ones(len(sizes), dtype=bool) if needed is None else needed
    cut = [cut_for(path, sizes, strips, fitting) for path in paths(chains, sizes)]
    laid = [path for path, _ in cut]
    shapes = [_Shape.of(path) for path in laid]
    shapes = [shape.ended(path, laid, shapes) for shape, path in zip(shapes, laid, strict=True)]
    return _Elements(laid, shapes).divided([cuts for _, cuts in cut])


def normal_of(tangent: Array) -> Array:
    """The outward normal (…, 2) of a contour that runs counter-clockwise."""
    return np.stack([tangent[..., 1], -tangent[..., 0]], axis=-1)


@dataclass(frozen=True, slots=True, eq=False)
class _Shape:
    """The pieces of a path, and the lines at both ends of each."""

    starts: Array
    stops: Array
    length: Array
    tangent: Array
    """(S, K, …)."""
    slant: Array
    """(S, K, 2, 2): by how much the lines at a piece's two ends depart from its normal."""
    intrusion: Array
    """(S, K, 2), m: how far they reach along the piece."""
    sharp: NDArray[np.bool_]
    """(K, 2): whether elements grow from an end."""

    @classmethod
    def of(cls, path: Path) -> _Shape:
        """With mitres at corners and normals at loose ends."""
        step = path.stops - path.starts
        length = np.hypot(step[..., 0], step[..., 1])
        tangent = step / length[..., None]
        thickness, seats = np.array(path.thickness), np.isin(np.arange(len(path.walls)), list(path.seats))
        slant, intrusion, sharp = _corners(tangent, thickness, path.closed)
        beside = np.stack([np.roll(seats, 1), np.roll(seats, -1)], axis=-1)
        if not path.closed:
            beside[0, 0] = beside[-1, 1] = False
        return cls(path.starts, path.stops, length, tangent, slant, intrusion, (sharp | beside) & ~seats[:, None])

    def line(self, piece: int, at: int) -> tuple[Array, Array]:
        """The line (S, 2), (S, 2) at the first (0) or last (1) end of a piece."""
        return (self.starts, self.stops)[at][:, piece], normal_of(self.tangent[:, piece]) + self.slant[:, piece, at]

    def ended(self, path: Path, laid: Sequence[Path], shapes: Sequence[_Shape]) -> _Shape:
        """With the first and the last line along the faces that the path ends on."""
        if path.ends == (None, None):
            return self
        starts, stops = self.starts.copy(), self.stops.copy()
        on_face: dict[int, Array] = {}
        for at, seat in enumerate(path.ends):
            if seat is not None:
                middle, on_face[at] = _face(seat, laid[seat.chain], shapes[seat.chain], path.thickness[-at])
                (starts, stops)[at][:, -at] = middle
        step = stops - starts
        length = np.hypot(step[..., 0], step[..., 1])
        tangent = step / length[..., None]
        slant, intrusion, sharp = self.slant.copy(), self.intrusion.copy(), self.sharp.copy()
        for at, direction in on_face.items():
            slant[:, -at, at] = direction - normal_of(tangent[:, -at])
            intrusion[:, -at, at] = 0.5 * path.thickness[-at] * np.abs((direction * tangent[:, -at]).sum(axis=-1))
            sharp[-at, at] = True
        return _Shape(starts, stops, length, tangent, slant, intrusion, sharp)


def _face(seat: Seat, path: Path, shape: _Shape, thickness: float) -> tuple[Array, Array]:
    """The line along the face of a seat: its middle (S, 2), and its direction per metre of a web's thickness."""
    far = (0.5 if seat.outside else -0.5) * path.thickness[seat.piece]
    low, high = (point + far * direction for point, direction in (shape.line(seat.piece, 0), shape.line(seat.piece, 1)))
    return 0.5 * (low + high), (high - low if seat.along else low - high) / thickness


def _corners(tangent: Array, thickness: Array, closed: bool) -> tuple[Array, Array, NDArray[np.bool_]]:
    """As ``_Shape`` has them, of pieces (S, K, 2) of thicknesses (K,)."""
    normal, before, thin = normal_of(tangent), np.roll(tangent, 1, axis=1), np.roll(thickness, 1)
    cosine = (before * tangent).sum(axis=-1)
    turn = np.arccos(np.clip(cosine, -1.0, 1.0))
    if not closed:
        cosine[:, 0] = 1.0  # nothing comes before
    mitre = (normal + np.roll(normal, 1, axis=1)) / (1.0 + cosine)[..., None]
    equal = np.abs(thickness - thin) <= 1e-12 * thickness
    reach = 0.5 * thickness * np.tan(0.5 * turn)
    bends = turn[0] > SHARP
    after, of_before, reach_before = mitre.copy(), mitre.copy(), reach.copy()
    for k in np.flatnonzero(~equal):  # from where both inner faces meet to where both outer ones do
        half = _meeting(np.roll(normal, 1, axis=1)[:, k], normal[:, k], 0.5 * thin[k], 0.5 * thickness[k], bool(bends[k]))
        after[:, k], of_before[:, k] = half / (0.5 * thickness[k]), half / (0.5 * thin[k])
        reach[:, k] = np.abs((half * tangent[:, k]).sum(axis=-1))
        reach_before[:, k] = np.abs((half * before[:, k]).sum(axis=-1))
    slant = np.stack([after - normal, np.roll(of_before, -1, axis=1) - normal], axis=2)
    intrusion = np.stack([reach, np.roll(reach_before, -1, axis=1)], axis=-1)
    grows = bends | ~equal
    sharp = np.stack([grows, np.roll(grows, -1)], axis=-1)
    if not closed:
        slant[:, 0, 0] = slant[:, -1, 1] = intrusion[:, 0, 0, None] = intrusion[:, -1, 1, None] = 0.0
        sharp[0, 0] = sharp[-1, 1] = True  # torsion's shear stresses turn round there
    return slant, intrusion, sharp


def _meeting(before: Array, after: Array, thin: float, thick: float, bends: bool) -> Array:
    """(S, 2), m: from where two mid-lines with normals (S, 2) meet to where lines at distances from them do."""
    if not bends:
        both = before + after
        return np.asarray(0.5 * (thin + thick) * both / (1.0 + (before * after).sum(axis=-1))[:, None])
    distances = np.broadcast_to(np.array([thin, thick]), (len(before), 2))
    return np.asarray(np.linalg.solve(np.stack([before, after], axis=1), distances[..., None])[..., 0])


class _Elements:
    """Elements as they are cut, path after path."""

    def __init__(self, laid: Sequence[Path], shapes: Sequence[_Shape]) -> None:
        self._laid, self._shapes = laid, shapes
        self._points: list[Array] = []
        self._directions: list[Array] = []
        self._tangents: list[Array] = []
        self._thickness: list[float] = []
        self._edges: list[Edge] = []
        self._lasts: list[tuple[Array, Array]] = []
        self._lines: list[list[int]] = []
        self._first_of: dict[tuple[int, int], int] = {}
        self._opens: list[bool] = []

    def divided(self, cuts: Sequence[Sequence[list[Cut]]]) -> Mesh:
        """The mesh."""
        count, joined = 0, []
        for number, (path, shape) in enumerate(zip(self._laid, self._shapes, strict=True)):
            first, begin = len(self._edges), count
            for piece in range(len(path.walls)):
                self._first_of[number, piece] = len(self._edges)
                self._cut(path, shape, piece, cuts[number][piece])
            elements = len(self._edges) - first
            self._opens += [not path.closed] * elements
            self._lines += [[begin + k, begin + k + 1] for k in range(elements)]
            count = begin + elements + (0 if path.closed else 1)
            if path.closed:
                self._lines[-1][1] = begin
            joined += [(first + at * (elements - 1), at, seat) for at, seat in enumerate(path.ends) if seat is not None]
        return self._with_joints(count, joined)

    def _cut(self, path: Path, shape: _Shape, piece: int, cuts: list[Cut]) -> None:
        """Add the elements of one piece."""
        thickness, wall = path.thickness[piece], path.walls[piece]
        length, tangent, slant = shape.length[:, piece], shape.tangent[:, piece], shape.slant[:, piece]
        grown = _grown(length, shape.intrusion[:, piece], thickness, wall)
        found = []
        for distance, strips in _lines(length, grown, shape.sharp[piece], cuts):
            share = np.stack([1.0 - distance / grown[:, 0], 1.0 - (length - distance) / grown[:, 1]], axis=-1)
            along = shape.starts[:, piece] + distance[:, None] * tangent
            found.append((along, normal_of(tangent) + (np.maximum(share, 0.0)[:, None] @ slant)[:, 0]))
            self._edges.append(Edge(wall, strips))
            self._tangents.append(tangent)
            self._thickness.append(thickness)
        self._points += [point for point, _ in found]
        self._directions += [direction for _, direction in found]
        self._lasts += [*found[1:], shape.line(piece, 1)]

    def _with_joints(self, count: int, joined: Sequence[tuple[int, int, Seat]]) -> Mesh:
        lines = np.array(self._lines, dtype=np.intp)
        lost = sorted(lines[element, at] for element, at, _ in joined)  # these lines are joints instead
        lines = lines - np.searchsorted(lost, lines)
        joints: list[Joint] = []
        for element, at, seat in joined:
            lines[element, at] = count - len(lost) + len(joints)
            host = self._first_of[seat.chain, seat.piece]
            joints.append(Joint(host, 1.0 if seat.outside else -1.0, 1.0 if seat.along else -1.0))
        last_points, last_directions = zip(*self._lasts, strict=True)
        arrays = (self._points, self._directions, last_points, last_directions, self._tangents)
        P, d, Q, e, along = (np.stack(each, axis=1) for each in arrays)
        thickness = np.array(self._thickness)
        opens = np.array(self._opens)
        return Mesh(P, d, Q, e, along, thickness, tuple(self._edges), lines, count - len(lost), tuple(joints), opens)


def _grown(length: Array, intrusion: Array, thickness: float, wall: str) -> Array:
    """How far (S, 2), m, the corners at both ends of a piece disturb it; ``ValueError`` where they leave no wall between them."""
    free = length - intrusion.sum(axis=1)
    if np.any(free <= 0.0):
        shortest = int((intrusion.sum(axis=1) / length).argmax())
        most, left = (
            thickness * length[shortest] / intrusion[shortest].sum(),
            f"a piece of the {wall} wall, {length[shortest]:.4g} m",
        )
        raise Refused("section.thickness", thickness, f"below {most:.4g} m, that the corners at its ends leave some of {left} long")
    return np.minimum(np.maximum(CORNER_ELEMENT * thickness, 2.0 * intrusion), intrusion + 0.4 * free[:, None])


def _lines(length: Array, grown: Array, sharp: NDArray[np.bool_], cuts: list[Cut]) -> list[tuple[Array, frozenset[Strip]]]:
    """Where lines cross one piece, (S,) m from its start, ascending, and the strips that what begins there is part of."""
    smallest = int(length.argmin())
    inner = cuts[1:]
    rooms = [float(inner[0].distance[smallest]), float((length - inner[-1].distance)[smallest])] if inner else [np.inf, np.inf]
    grows = [bool(is_sharp) and room > 1.2 * far for is_sharp, room, far in zip(sharp, rooms, grown[smallest], strict=True)]
    lines = [(np.zeros_like(length), cuts[0].strips)]
    lines += [(grown[:, 0], cuts[0].strips)] if grows[0] else []
    lines += [(cut.distance, cut.strips) for cut in inner]
    return lines + ([(length - grown[:, 1], cuts[-1].strips)] if grows[1] else [])
