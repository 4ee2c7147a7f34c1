"""Open sections: strips, I, C and Z, and any walls that stand on one another without closing a cell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import CoreSchema, core_schema

from beamenv.configuration import Choice, Points, Refused, configuration
from beamenv.configuration.kinds import JsonSchema, Kind, plain
from beamenv.structure.section.section import Metres, Section
from beamenv.structure.section.wall_thicknesses import Thicknesses
from beamenv.structure.walls.chain import Chain

Array = NDArray[np.float64]

LINE = Points(least=2, most=1000, unit="m")


class OpenSection(Section):
    """Walls that close no cell."""

    closed = False
    thicknesses: tuple[tuple[str, float], ...]

    @property
    def own_thicknesses(self) -> dict[str, float]:
        """m, of walls that have one of their own."""
        return dict(self.thicknesses)

    def check_walls(self) -> None:
        """``ValueError`` for thicknesses of walls that are none, and for corners that leave no room."""
        names = self.wall_names
        for wall, _ in self.thicknesses:
            if wall not in names:
                raise Refused("thicknesses", wall, f"for walls of the section: {', '.join(names)}")
        self.check_corners()


@configuration("section")
class StripSection(OpenSection):
    """A solid strip: ``width`` along x, ``thickness`` along y, m. Its one wall is the strip; its outer face is up."""

    width: Metres
    thickness: Metres
    thicknesses: Thicknesses = ()
    shape: Annotated[str, Choice(("strip",))] = "strip"

    def __post_init__(self) -> None:
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(2, 2), from right to left."""
        return np.array([[0.5 * self.width, 0.0], [-0.5 * self.width, 0.0]])

    @property
    def walls(self) -> tuple[str, ...]:
        """The strip."""
        return ("strip",)


@configuration("section")
class CSection(OpenSection):
    """A channel, open to the right: mid-lines of flanges ``width`` long and of a web ``depth`` high, m.

    Its walls are top, web, bottom.
    """

    width: Metres
    depth: Metres
    thickness: Metres
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("c",))] = "c"

    def __post_init__(self) -> None:
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(4, 2), from the tip of the upper flange."""
        w, d = self.width, 0.5 * self.depth
        return np.array([[w, d], [0.0, d], [0.0, -d], [w, -d]])

    @property
    def walls(self) -> tuple[str, ...]:
        """top, web, bottom."""
        return ("top", "web", "bottom")


@configuration("section")
class ZSection(OpenSection):
    """A Z: its upper flange, ``width`` long, to the right, its lower one to the left of a web ``depth`` high, m; mid-lines.

    Its walls are top, web, bottom.
    """

    width: Metres
    depth: Metres
    thickness: Metres
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("z",))] = "z"

    def __post_init__(self) -> None:
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(4, 2), from the tip of the upper flange."""
        w, d = self.width, 0.5 * self.depth
        return np.array([[w, d], [0.0, d], [0.0, -d], [-w, -d]])

    @property
    def walls(self) -> tuple[str, ...]:
        """top, web, bottom."""
        return ("top", "web", "bottom")


@configuration("section")
class ISection(OpenSection):
    """An I: flanges ``width`` wide and a web ``depth`` high between their mid-lines, m. Its walls are top, bottom, web."""

    width: Metres
    depth: Metres
    thickness: Metres
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("i",))] = "i"

    def __post_init__(self) -> None:
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(2, 2): the upper flange, from right to left."""
        w, d = 0.5 * self.width, 0.5 * self.depth
        return np.array([[w, d], [-w, d]])

    @property
    def walls(self) -> tuple[str, ...]:
        """The upper flange."""
        return ("top",)

    @property
    def further(self) -> tuple[Chain, ...]:
        """The lower flange and the web."""
        bottom = self.vertices * np.array([-1.0, -1.0])
        web = np.array([[0.0, -0.5 * self.depth], [0.0, 0.5 * self.depth]])
        parts = (("bottom", bottom), ("web", web))
        return tuple(Chain(points, (wall,), (self.thickness_of(wall),), closed=False) for wall, points in parts)


@dataclass(frozen=True, slots=True)
class Lines(Kind):
    """A mapping of walls to the points of their mid-lines; kept as pairs."""

    @property
    def allowed(self) -> str:
        """Say, {"web": [[0, -0.02], [0, 0.02]]}."""
        return f"a table of walls, each with {LINE.allowed}"

    def core(self) -> CoreSchema:
        """Pairs of a wall and its points."""
        pair = core_schema.tuple_schema([core_schema.str_schema(strict=True), LINE.core()], strict=True)
        return core_schema.no_info_before_validator_function(
            _pairs, core_schema.tuple_variable_schema(pair, min_length=1, strict=True)
        )

    def json(self) -> JsonSchema:
        """An object of arrays."""
        return {"type": "object", "additionalProperties": LINE.json(), "minProperties": 1}


def _pairs(value: Any) -> Any:
    return plain(tuple(value.items()) if isinstance(value, Mapping) else value)


@configuration("section")
class WallsSection(OpenSection):
    """Any open section, by the mid-lines of its walls: points [x, y] (m) of each.

    A wall that begins where the one before it ends goes on from it; one that ends on another's mid-line stands on it. Seen along a
    wall, its outer face is on the right.

    Raises ``ValueError`` for walls that cross, or that touch no other.
    """

    drawn_by = "lines"

    lines: Annotated[tuple[tuple[str, tuple[tuple[float, float], ...]], ...], Lines()]
    thickness: Metres
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("walls",))] = "walls"

    def __post_init__(self) -> None:
        for wall, points in self.lines:
            if np.any(np.hypot(*np.diff(np.array(points), axis=0).T) == 0.0):
                raise Refused(f"lines.{wall}", points, "points of which no two in turn coincide")
        for chain in self._joined():
            if np.allclose(chain.points[0], chain.points[-1], rtol=0.0, atol=1e-9):
                raise Refused("lines", chain.walls, "walls that close no cell: closed ones are a polygon with its webs")
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(K, 2): of the first walls that go on from one another."""
        return self._joined()[0].points

    @property
    def walls(self) -> tuple[str, ...]:
        """Those walls."""
        return self._joined()[0].walls

    @property
    def further(self) -> tuple[Chain, ...]:
        """The others."""
        return tuple(self._joined()[1:])

    def _joined(self) -> list[Chain]:
        found: list[Chain] = []
        for wall, points in self.lines:
            line = np.array(points)
            names, thick = (wall,) * (len(line) - 1), (self.thickness_of(wall),) * (len(line) - 1)
            before = found[-1] if found else None
            if before is not None and np.allclose(before.points[-1], line[0], rtol=0.0, atol=1e-9):
                points_of = np.concatenate([before.points, line[1:]])
                found[-1] = Chain(points_of, before.walls + names, before.thickness + thick, closed=False)
            else:
                found.append(Chain(line, names, thick, closed=False))
        return found
