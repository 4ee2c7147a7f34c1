"""How a section is turned and scaled along the span, evenly or by tables, and how hot it is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Points, Refused
from beamenv.structure.geometrically_exact.rotations import about_span

Array = NDArray[np.float64]
Steps = tuple[tuple[float, float], ...]

SIZES = 9
"""Sizes at which the sections of a tapered blade are worked out; between them its properties, smooth functions of the size, follow
a polynomial."""

SIZES_OF_PIECE = 7
"""The same of each of several pieces of the span."""

TEMPERATURES = 4
"""The same of a piece that is not equally hot all along, where it is not tapered: materials follow cubic curves within it."""

LEAST_PIECE = 0.02
"""Of the span."""

SHARP = 0.05
"""Change of a table's slope, of the twist in rad or of the size over that there, per span, from which a corner is one to the trial
functions: those of a smooth curve in many points are not."""

MOST_CORNERS = 8
"""The sharpest."""

TABLE = Points(least=2, most=100)
"""Pairs of a share of the span and what is there, from 0 to 1."""


class Piece(NamedTuple):
    """A piece of the span along which the twist changes evenly, and so does the size."""

    start: float
    end: float
    """m."""
    rate: float
    """rad/m."""
    sizes: tuple[float, ...]
    """Of the sections that are worked out, over that of the root."""
    temperatures: tuple[float, ...] | None = None
    """K, of them; None: all as their data have it."""

    @property
    def nodes(self) -> Array:
        """What tells the sections worked out apart, (n,): the size, or where they are not equally hot the temperature."""
        temperatures = self.temperatures
        return np.array(self.sizes if temperatures is None or len(set(temperatures)) == 1 else temperatures)

    @property
    def by_temperature(self) -> bool:
        """Whether it is the temperature."""
        return self.temperatures is not None and len(set(self.temperatures)) > 1


@dataclass(frozen=True)
class Planform:
    """How the section is turned and scaled along the span."""

    length: float
    pretwist: float
    presetting: float
    """rad, of the whole span and of the root."""
    taper: float
    twists: Steps | None = None
    """Shares of the span and the pretwist (rad) there, straight in between; None: evenly to ``pretwist``."""
    chords: Steps | None = None
    """Shares of the span and the size there over that of the root, straight in between; None: evenly to 1/``taper``."""
    covered: float = 0.0
    """m: up to where inlays lie; a tapered blade is in two pieces there, for theirs need not fit further out."""
    temperatures: Steps | None = None
    """Shares of the span and the temperature (K) there, straight in between; None: that at which the blade's data hold."""

    def scale(self, z: Array) -> Array:
        """Size over that of the root (S,)."""
        if self.chords is not None:
            return _straight(self.chords, z / self.length)
        tip = 1.0 / self.taper
        return tip + (1.0 - tip) * (1.0 - z / self.length)

    def angle(self, z: Array) -> Array:
        """Of the chord from the plane of rotation (S,), rad."""
        if self.twists is not None:
            return self.presetting + _straight(self.twists, z / self.length)
        return self.presetting + self.pretwist * z / self.length

    def temperature(self, z: Array) -> Array:
        """K (S,), where there is one."""
        assert self.temperatures is not None
        return _straight(self.temperatures, z / self.length)

    def frames(self, z: Array) -> Array:
        """C₀ (S, 3, 3): the axes of the sections."""
        return about_span(self.angle(z))

    @property
    def narrowest(self) -> float:
        """Size where it is smallest, over that of the root, or 1."""
        return min(1.0, *(size for piece in self.pieces for size in piece.sizes))

    @property
    def turned(self) -> float:
        """rad: by how much the section turns on its way, forth and back."""
        return sum(abs(piece.rate) * (piece.end - piece.start) for piece in self.pieces)

    @property
    def corners(self) -> tuple[float, ...]:
        """m: where tables of twist and size bend sharply."""
        bends: dict[float, float] = {}
        for table, unit in ((self.twists, np.ones_like), (self.chords, np.abs)):
            shares, values = np.array(table or ((0.0, 1.0), (1.0, 1.0))).T
            bend = np.abs(np.diff(np.diff(values) / np.diff(shares))) / unit(values[1:-1])
            bends |= {share: max(bends.get(share, 0.0), by) for share, by in zip(shares[1:-1].tolist(), bend.tolist(), strict=True)}
        sharpest = sorted((share for share in bends if bends[share] > SHARP), key=lambda share: -bends[share])[:MOST_CORNERS]
        return tuple(self.length * share for share in sorted(sharpest))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One where neither is by a table."""
        tapered = self.taper != 1.0 if self.chords is None else len({size for _, size in self.chords}) > 1
        tables = self.twists, self.chords, self.temperatures
        end, known = self.covered / self.length, {share for table in tables for share, _ in table or ()}
        near = any(-1e-9 <= share - end <= LEAST_PIECE for share in {1.0, *known})
        split = {end} if tapered and end > LEAST_PIECE and not near else set()
        shares = sorted({0.0, 1.0, *split, *known})
        several = len(shares) > 2
        return tuple(self._piece(low, high, several) for low, high in zip(shares[:-1], shares[1:], strict=True))

    def _piece(self, low: float, high: float, several: bool) -> Piece:
        ends = self.length * np.array([low, high])
        rate = self.pretwist / self.length if self.twists is None else float(np.diff(self.angle(ends))[0] / np.diff(ends)[0])
        first, last = (1.0, 1.0 / self.taper) if self.chords is None and not several else self.scale(ends).tolist()
        count = SIZES_OF_PIECE if several else SIZES
        sizes, temperatures = _between(first, last, count), None
        if self.temperatures is not None:
            coldest, hottest = self.temperature(ends).tolist()
            hot = _between(coldest, hottest, count if len(sizes) > 1 else TEMPERATURES)
            most = max(len(sizes), len(hot))
            sizes, temperatures = (each * most if len(each) == 1 else each for each in (sizes, hot))
        return Piece(float(ends[0]), float(ends[1]), rate, sizes, temperatures)


def _between(first: float, last: float, count: int) -> tuple[float, ...]:
    """Chebyshev points from one size to another, both included; one where they are the same."""
    if last == first:
        return (first,)
    nodes = np.cos(np.pi * np.arange(count) / (count - 1))
    return tuple((0.5 * (first + last) + 0.5 * (first - last) * nodes).tolist())


def _straight(table: Steps, share: Array) -> Array:
    shares, values = np.array(table).T
    return np.asarray(np.interp(share, shares, values))


def check_table(name: str, table: Steps | None, least: float = -np.inf) -> None:
    """``ValueError`` for a table that does not ascend from the root, 0, to the tip, 1, or has values not above ``least``."""
    if table is None:
        return
    shares, values = np.array(table).T
    if shares[0] != 0.0 or shares[-1] != 1.0 or np.any(np.diff(shares) <= 0.0) or np.any(values <= least):
        above = "" if least == -np.inf else f", with values above {least:g}"
        raise Refused(name, table, f"pairs [share of the span, value] that ascend from share 0 to share 1{above}")
