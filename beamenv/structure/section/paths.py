"""Where the walls of a section run at each of its sizes, and where one wall ends on another.

A web ends on a face of the wall that holds it. There that wall has a piece as long as the web is thick, its *seat*; the web's last
line across lies along the face of that piece. Seats keep their length, the web's thickness, whatever the section's size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.structure.scale import Contradiction
from beamenv.structure.section.standing import check_apart, check_joined
from beamenv.structure.walls.chain import Chain

Array = NDArray[np.float64]

SHARP = np.radians(12.0)
"""Turn of the contour beyond which a corner disturbs the stresses, and elements grow from it."""

ON_WALL = 1e-6
"""Of the section's size: a wall that ends nearer than this to another's mid-line ends on it."""

STEEPEST = np.sin(np.radians(20.0))
"""Least sine of the angle between a web and the wall that it ends on."""

ROOM = 0.5
"""Of a seat's half length: corners of a smooth contour nearer than this to a seat give way to it."""


@dataclass(frozen=True, slots=True)
class Seat:
    """The piece of a wall that another one ends on."""

    chain: int
    piece: int
    outside: bool
    """Whether the other wall is on the outer face."""
    along: bool
    """Whether the line that the other wall ends with runs as the piece does, and not against it."""


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A chain of K pieces at S sizes."""

    points: Array
    """(S, N, 2), m."""
    walls: tuple[str, ...]
    thickness: tuple[float, ...]
    closed: bool
    seats: frozenset[int]
    """Pieces that other walls end on."""
    ends: tuple[Seat | None, Seat | None]
    """What the first and the last piece of an open chain end on; None: nothing, or closed."""

    @property
    def starts(self) -> Array:
        """(S, K, 2), m."""
        return self.points if self.closed else self.points[:, :-1]

    @property
    def stops(self) -> Array:
        """(S, K, 2), m."""
        return np.roll(self.points, -1, axis=1) if self.closed else self.points[:, 1:]

    @property
    def arcs(self) -> Array:
        """(S, K + 1), m: distance of the pieces' ends from the start of the chain, along it."""
        lengths = np.hypot(*np.moveaxis(self.stops - self.starts, -1, 0))
        return np.concatenate([np.zeros((len(lengths), 1)), np.cumsum(lengths, axis=1)], axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class _Landing:
    """An end of one chain on another."""

    guest: int
    last: bool
    host: int
    middle: Array
    """(S,), m along the host, of the seat."""
    half: float
    """m, of the seat's length."""
    outside: bool
    along: bool

    def alike(self, other: _Landing) -> bool:
        return bool(np.allclose(self.middle, other.middle, rtol=1e-9, atol=1e-9 * self.half) and np.isclose(self.half, other.half))


def paths(chains: Sequence[Chain], sizes: Array) -> tuple[Path, ...]:
    """The chains at sizes (S,) with a seat wherever one ends on another; ``ValueError`` where that cannot be."""
    landings = [
        landing
        for guest, chain in enumerate(chains)
        if not chain.closed
        for last in (False, True)
        if (landing := _landing(chains, guest, last, sizes)) is not None
    ]
    check_apart(chains)
    check_joined(chains, [(landing.guest, landing.host) for landing in landings])
    laid = [_with_seats(chain, [each for each in landings if each.host == k], sizes) for k, chain in enumerate(chains)]
    found: dict[tuple[int, bool], Seat] = {}
    for landing in landings:
        piece = laid[landing.host][1][_first_alike(landing, landings)]
        found[landing.guest, landing.last] = Seat(landing.host, piece, landing.outside, landing.along)
    return tuple(
        Path(path.points, path.walls, path.thickness, path.closed, path.seats, (found.get((k, False)), found.get((k, True))))
        for k, (path, _) in enumerate(laid)
    )


def _first_alike(landing: _Landing, landings: Sequence[_Landing]) -> int:
    """Place of a landing, or of one opposite to it, among those of its host."""
    own = [each for each in landings if each.host == landing.host]
    return next(k for k, each in enumerate(own) if each.alike(landing))


def _landing(chains: Sequence[Chain], guest: int, last: bool, sizes: Array) -> _Landing | None:
    chain = chains[guest]
    point, before = (chain.points[-1], chain.points[-2]) if last else (chain.points[0], chain.points[1])
    extent = max(float(np.ptp(each.points, axis=0).max()) for each in chains)
    thick, wall = (chain.thickness[-1], chain.walls[-1]) if last else (chain.thickness[0], chain.walls[0])
    for host, other in enumerate(chains):
        if host == guest:
            continue
        starts, lengths = other.starts, other.lengths
        tangents = (other.ends - starts) / lengths[:, None]
        along = np.clip(((point - starts) * tangents).sum(axis=1), 0.0, lengths)
        apart = np.linalg.norm(starts + along[:, None] * tangents - point, axis=1)
        piece = int(apart.argmin())
        if apart[piece] > ON_WALL * extent:
            continue
        into = (before - point) / np.linalg.norm(before - point)
        normal = np.array([tangents[piece, 1], -tangents[piece, 0]])
        sine, cosine = float(into @ normal), float(into @ tangents[piece])
        if abs(sine) < STEEPEST:
            raise Refused("section", f"wall {wall!r}", f"at 20° or more to the {other.walls[piece]} wall that it ends on")
        arc = float(lengths[:piece].sum() + along[piece])
        shift = 0.5 * other.thickness[piece] * cosine / abs(sine)
        guest_normal = np.array([into[1], -into[0]]) * (-1.0 if last else 1.0)
        return _Landing(
            guest=guest,
            last=last,
            host=host,
            middle=sizes * arc + shift,
            half=0.5 * thick / abs(sine),
            outside=sine > 0.0,
            along=bool(guest_normal @ tangents[piece] > 0.0),
        )
    return None


def _with_seats(chain: Chain, landings: Sequence[_Landing], sizes: Array) -> tuple[Path, list[int]]:
    """The chain with its seats, and the piece that each landing has."""
    points = sizes[:, None, None] * chain.points
    plain = Path(points, chain.walls, chain.thickness, chain.closed, frozenset(), (None, None))
    if not landings:
        return plain, []
    arcs = plain.arcs
    total = arcs[:, -1]
    marks: list[tuple[Array, int]] = []  # where along the chain, and the seat that begins (k) or ends (~k) there, or a corner
    own = [k for k, each in enumerate(landings) if _first_alike(each, landings) == k]
    kept = [k for k in range(points.shape[1]) if not any(_gives_way(chain, k, arcs, landings[j]) for j in own)]
    for j in own:
        low, high = landings[j].middle - landings[j].half, landings[j].middle + landings[j].half
        if np.any(low <= 0.0) or np.any(high >= total):
            raise _too_near(chain)
        marks += [(low, j), (high, ~j)]
    corner = len(landings)
    places = [(arcs[:, k], corner + k) for k in kept] + marks
    places.sort(key=lambda each: float(each[0][0]))
    levels = np.stack([where for where, _ in places], axis=1)
    if np.any(np.diff(levels, axis=1) <= 0.0):
        raise _too_near(chain)
    closing = np.concatenate([points, points[:, :1]], axis=1) if chain.closed else points
    at = np.stack([_along(closing[s], arcs[s], levels[s]) for s in range(len(sizes))])
    middles = 0.5 * (levels[0] + np.append(levels[0, 1:], total[0] + (levels[0, 0] if chain.closed else 0.0)))
    count = len(places) - (0 if chain.closed else 1)
    pieces = (np.searchsorted(arcs[0], middles[:count] % total[0], side="right") - 1).clip(0, len(chain.walls) - 1)
    found = {what: k for k, (_, what) in enumerate(places)}
    seats = [found[_first_alike(each, landings)] for each in landings]
    for k in set(seats):
        if places[k + 1][1] >= 0:
            raise _too_near(chain)
    path = Path(
        at,
        tuple(chain.walls[k] for k in pieces),
        tuple(chain.thickness[k] for k in pieces),
        chain.closed,
        frozenset(seats),
        (None, None),
    )
    return path, seats


def _gives_way(chain: Chain, corner: int, arcs: Array, landing: _Landing) -> bool:
    """Whether a corner lies where a seat is to be; ``ValueError`` for a sharp one, or the start of the chain."""
    if not np.any(np.abs(arcs[:, corner] - landing.middle) <= (1.0 + ROOM) * landing.half):
        return False
    if corner in (0, len(chain.points) - 1) and not chain.closed:
        raise _too_near(chain)
    tangents = (chain.ends - chain.starts) / chain.lengths[:, None]
    before, after = tangents[corner - 1], tangents[corner % len(tangents)]
    if np.arccos(np.clip(before @ after, -1.0, 1.0)) > SHARP:
        if np.any(np.abs(arcs[:, corner] - landing.middle) <= landing.half):
            raise _too_near(chain)
        return False
    if corner == 0:
        raise _too_near(chain)
    return True


def _along(points: Array, arcs: Array, at: Array) -> Array:
    """(k, 2): places at distances (k,) along a line of points."""
    return np.stack([np.interp(at, arcs, points[:, axis]) for axis in range(2)], axis=-1)


def _too_near(chain: Chain) -> Contradiction:
    names = ", ".join(dict.fromkeys(chain.walls))
    near = "too near to a corner, an end or another web: within its thickness"
    return Contradiction(f"section has a wall that ends on {names} {near}.")
