"""Mid-lines of walls that follow one another: what a section is drawn with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """Straight pieces of walls from corner to corner of a mid-line: N of them around a closed one, N − 1 along an open one."""

    points: Array
    """(N, 2), m; counter-clockwise if closed."""
    walls: tuple[str, ...]
    """The wall that each piece is of."""
    thickness: tuple[float, ...]
    """m, of each piece."""
    closed: bool = True

    @property
    def starts(self) -> Array:
        """(K, 2), m: where each piece begins."""
        return self.points if self.closed else self.points[:-1]

    @property
    def ends(self) -> Array:
        """(K, 2), m: where each piece ends."""
        return np.roll(self.points, -1, axis=0) if self.closed else self.points[1:]

    @property
    def lengths(self) -> Array:
        """(K,), m."""
        return np.asarray(np.hypot(*(self.ends - self.starts).T))

    @property
    def first_moments(self) -> Array:
        """∫(x, y) ds (2,), m²."""
        return np.asarray(0.5 * (self.lengths @ (self.starts + self.ends)))

    def shifted(self, by: Array) -> Chain:
        """The chain moved by (2,) m."""
        return Chain(self.points + by, self.walls, self.thickness, self.closed)

    def part(self, wall: str) -> tuple[int, int] | None:
        """From which piece to before which one a wall goes; None where its pieces do not follow one another."""
        of_it = [k for k, name in enumerate(self.walls) if name == wall]
        if not of_it or of_it[-1] - of_it[0] + 1 != len(of_it):
            return None
        return of_it[0], of_it[-1] + 1
