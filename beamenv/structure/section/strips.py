"""Where strips of walls begin and end on the pieces of a path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.structure.section.paths import SHARP, Path
from beamenv.structure.walls.inlay import Strip

Array = NDArray[np.float64]

NARROWEST = 1e-3
"""Of a wall: a strip that leaves less of it on either side is taken to leave this much."""

WHOLE = 1e-9
"""Of a wall: a strip that leaves less of it on either side at every size covers it to its end; nearer places are one."""


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """A line on a piece, and what begins there."""

    distance: Array
    """(S,), m from the start of the piece."""
    strips: frozenset[Strip]


@dataclass(frozen=True, slots=True, eq=False)
class _Mark:
    """An edge of a strip."""

    strip: Strip
    begins: bool
    level: Array
    """(S,), m from the start of the wall."""


def cut_for(path: Path, sizes: Array, strips: Sequence[Strip], needed: NDArray[np.bool_]) -> tuple[Path, list[list[Cut]]]:
    """The path, and for each of its pieces the cuts, ascending; the first, at its start, tells what strips the piece begins in.

    A strip keeps its width at every size. The corners of a smooth wall follow its edges, along the wall's own line, so that the
    same corners lie between them at every size. Where it is not ``needed`` (S,) and does not fit, it is narrower as the section is.
    """
    found = [[Cut(np.zeros(len(sizes)), frozenset())] for _ in path.walls]
    for wall in dict.fromkeys(strip.wall for strip in strips if strip.wall in path.walls):
        pieces = [k for k, name in enumerate(path.walls) if name == wall]
        if pieces[-1] - pieces[0] + 1 != len(pieces):
            raise Refused("wall", wall, "a wall of one part, for patches to lie on")
        own = sorted({strip for strip in strips if strip.wall == wall}, key=lambda strip: (strip.width, strip.offset))
        path = _divide(found, path, pieces, sizes, own, needed)
    return path, found


def _divide(
    found: list[list[Cut]], path: Path, pieces: list[int], sizes: Array, strips: Sequence[Strip], needed: NDArray[np.bool_]
) -> Path:
    """Put the cuts of one wall's strips where they belong; the path with corners that follow."""
    ends = _ends(path, pieces)
    total = ends[:, -1]
    marks = sorted((mark for strip in strips for mark in _marks(total, sizes, strip)), key=lambda mark: float(mark.level[0]))
    if len(sizes) > 1 and len(pieces) > 1 and marks:
        marks = _fitted(path, pieces, ends, marks, needed)
        path, ends, marks = _following(path, pieces, ends, marks)
    under = frozenset(strip for strip in strips if _reaches_start(total, sizes, strip))
    near = WHOLE * total[0]
    which = [int(np.searchsorted(ends[0], mark.level[0] + near, side="right")) - 1 for mark in marks]
    for place, piece in enumerate(pieces):
        cuts = [Cut(np.zeros(len(sizes)), under)]
        for mark in (mark for mark, at in zip(marks, which, strict=True) if at == place):
            distance = mark.level - ends[:, place] if place else mark.level
            under = under | {mark.strip} if mark.begins else under - {mark.strip}
            if np.all(np.abs(distance - cuts[-1].distance) <= near):
                cuts[-1] = replace(cuts[-1], strips=under)
                continue
            if piece in path.seats or np.any(distance <= cuts[-1].distance) or np.any(mark.level >= ends[:, place + 1]):
                raise _refused(mark, path.walls[piece])
            cuts.append(Cut(distance, under))
        found[piece] = cuts
    return path


def _ends(path: Path, pieces: list[int]) -> Array:
    """(S, k + 1), m from the start of a wall: where its k pieces begin and end."""
    steps = (path.stops - path.starts)[:, pieces]
    lengths = np.hypot(steps[..., 0], steps[..., 1])
    return np.concatenate([np.zeros((len(lengths), 1)), np.cumsum(lengths, axis=1)], axis=1)


def _marks(total: Array, sizes: Array, strip: Strip) -> list[_Mark]:
    """Where a strip begins and ends."""
    before, after = _margins(total, sizes, strip)
    if np.any(before < -strip.width) or np.any(after < -strip.width):
        raise Refused("offset", strip.offset, f"one that leaves the strip on the {strip.wall} wall")
    marks = []
    if not _reaches_start(total, sizes, strip):
        marks.append(_Mark(strip, True, np.maximum(before, NARROWEST * total)))
    if not np.all(after <= WHOLE * total):
        marks.append(_Mark(strip, False, total - np.maximum(after, NARROWEST * total)))
    return marks


def _reaches_start(total: Array, sizes: Array, strip: Strip) -> bool:
    return bool(np.all(_margins(total, sizes, strip)[0] <= WHOLE * total))


def _margins(total: Array, sizes: Array, strip: Strip) -> tuple[Array, Array]:
    """(S,) m each: what a strip leaves of its wall before it and after it."""
    half, offset = 0.5 * strip.width, sizes * strip.offset
    return 0.5 * total - half + offset, 0.5 * total - half - offset


def _fitted(path: Path, pieces: list[int], ends: Array, marks: list[_Mark], needed: NDArray[np.bool_]) -> list[_Mark]:
    """Marks where what is fixed along a wall leaves them room; ``ValueError`` where it does not at a size that is ``needed``."""
    fixed = ends[:, _fixed(path, pieces)]
    levels = np.stack([mark.level for mark in marks], axis=1)
    order = np.argsort(np.concatenate([fixed, levels], axis=1)[0], kind="stable")
    steps = np.diff(np.concatenate([fixed, levels], axis=1)[:, order], axis=1)
    tight = np.any(steps < -WHOLE * ends[:, -1:], axis=1)
    if np.any(tight & needed):
        raise _refused(marks[0], path.walls[pieces[0]])
    for row in np.flatnonzero(tight):
        levels[row] = np.interp(levels[0], fixed[0], fixed[row])
    return [replace(mark, level=level) for mark, level in zip(marks, levels.T, strict=True)]


def _following(path: Path, pieces: list[int], ends: Array, marks: list[_Mark]) -> tuple[Path, Array, list[_Mark]]:
    """The path with smooth corners moved along one wall as the strips' edges move, and the edges' places along it."""
    fixed = _fixed(path, pieces)
    knots = np.concatenate([ends[:, fixed], np.stack([mark.level for mark in marks], axis=1)], axis=1)
    order = np.argsort(knots[0], kind="stable")
    knots = knots[:, order]
    moved = np.stack([np.interp(ends[0], knots[0], row) for row in knots])
    moved[:, fixed] = ends[:, fixed]
    points = path.points.copy()
    line = np.concatenate([path.starts[:, pieces], path.stops[:, pieces[-1:]]], axis=1)
    for s in range(len(points)):
        for k, piece in enumerate(pieces):
            points[s, piece] = [np.interp(moved[s, k], ends[s], line[s, :, axis]) for axis in range(2)]
    path = replace(path, points=points)
    now = _ends(path, pieces)
    levels = [np.array([np.interp(mark.level[s], moved[s], now[s]) for s in range(len(now))]) for mark in marks]
    return path, now, [replace(mark, level=level) for mark, level in zip(marks, levels, strict=True)]


def _fixed(path: Path, pieces: list[int]) -> NDArray[np.bool_]:
    """(k + 1,): which ends of a wall's pieces stay where they are: the wall's own, those of seats, and sharp corners."""
    steps = (path.stops - path.starts)[0, pieces]
    heading = np.arctan2(steps[:, 1], steps[:, 0])
    turn = np.abs((np.diff(heading) + np.pi) % (2.0 * np.pi) - np.pi)
    inner = (turn > SHARP) | np.array([bool({a, b} & path.seats) for a, b in zip(pieces[:-1], pieces[1:], strict=True)], dtype=bool)
    return np.concatenate([[True], inner, [True]])


def _refused(mark: _Mark, wall: str) -> Refused:
    allowed = f"one at which the strip's edges keep away from webs and corners of the {wall} wall"
    return Refused("offset", mark.strip.offset, allowed)
