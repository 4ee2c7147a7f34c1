"""Closed sections: boxes, tubes and polygons, with webs or without."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Items, Points, Refused, Texts, configuration
from beamenv.structure.section.section import Metres, Section
from beamenv.structure.section.wall_thicknesses import Thicknesses
from beamenv.structure.section.webs import Web, web_chains
from beamenv.structure.walls.chain import Chain
from beamenv.structure.walls.contour import meets_itself

Array = NDArray[np.float64]

MOST_CORNERS = 1000
"""Of a polygon: more than any contour needs."""

FACETS = 96
"""Straight pieces of a round contour: its area is then 7·10⁻⁴ less than the ellipse's, its length 2·10⁻⁴."""


class ClosedSection(Section):
    """A closed contour, and webs across it."""

    webs: tuple[Web, ...]
    thicknesses: tuple[tuple[str, float], ...]

    @property
    def own_thicknesses(self) -> dict[str, float]:
        """m, of walls that have one of their own."""
        return dict(self.thicknesses)

    @property
    def further(self) -> tuple[Chain, ...]:
        """The webs."""
        contour = Chain(self.vertices, self.walls, tuple(map(self.thickness_of, self.walls)))
        return web_chains(self.webs, contour, self.own_thicknesses, self.thickness)

    def check_walls(self) -> None:
        """``ValueError`` for webs that do not fit, or named as another wall is, thicknesses of walls that are none, thick walls."""
        taken = dict.fromkeys(self.walls)
        for k, web in enumerate(self.webs):
            if web.name in taken:
                raise Refused(f"webs[{k}].name", web.name, f"another name than those of the other walls: {', '.join(taken)}")
            taken[web.name] = None
        names = self.wall_names
        for wall, _ in self.thicknesses:
            if wall not in names:
                raise Refused("thicknesses", wall, f"for walls of the section: {', '.join(names)}")
        self.check_thickness()
        self.check_corners()


@configuration("section")
class BoxSection(ClosedSection):
    """A rectangular box: mid-line ``width`` along x, ``depth`` along y, wall ``thickness``, all in m.

    Its walls are right, top, left and bottom. Raises ``ValueError`` for a dimension that is not positive or a wall too thick.
    """

    width: Metres
    depth: Metres
    thickness: Metres
    webs: Annotated[tuple[Web, ...], Items(Web)] = ()
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("box",))] = "box"

    def __post_init__(self) -> None:
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(4, 2), from the right wall's lower end."""
        c, b = 0.5 * self.width, 0.5 * self.depth
        return np.array([[c, -b], [c, b], [-c, b], [-c, -b]])

    @property
    def walls(self) -> tuple[str, ...]:
        """right, top, left, bottom."""
        return ("right", "top", "left", "bottom")

    @property
    def thickness_limit(self) -> float:
        """The smaller of width and depth."""
        return min(self.width, self.depth)


@configuration("section")
class TubeSection(ClosedSection):
    """A round tube: the axes ``width`` along x and ``depth`` along y of its mid-line, an ellipse, and wall ``thickness``, all in m.

    Its walls are right, top, left and bottom, a quarter each. Raises ``ValueError`` for a dimension that is not positive or a wall
    too thick.
    """

    width: Metres
    depth: Metres
    thickness: Metres
    webs: Annotated[tuple[Web, ...], Items(Web)] = ()
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("tube",))] = "tube"

    def __post_init__(self) -> None:
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(``FACETS``, 2), from the right wall's lower end."""
        angle = 2.0 * np.pi * np.arange(FACETS) / FACETS - 0.25 * np.pi
        return np.stack([0.5 * self.width * np.cos(angle), 0.5 * self.depth * np.sin(angle)], axis=-1)

    @property
    def walls(self) -> tuple[str, ...]:
        """right, top, left, bottom."""
        return tuple(np.repeat(["right", "top", "left", "bottom"], FACETS // 4).tolist())

    @property
    def thickness_limit(self) -> float:
        """Twice the smallest radius of curvature, or the smaller axis."""
        small, large = sorted((self.width, self.depth))
        return small * small / large


@configuration("section")
class PolygonSection(ClosedSection):
    """Any closed polygon: corners (x, y) of the mid-line in m, counter-clockwise, the wall name of each edge, the wall thickness.

    Raises ``ValueError`` for fewer than three corners, two that coincide, a clockwise order, a mid-line that crosses or touches
    itself, a number of wall names other than that of the edges, or a wall too thick.
    """

    drawn_by = "corners"

    corners: Annotated[tuple[tuple[float, float], ...], Points(least=3, most=MOST_CORNERS, unit="m")]
    edge_walls: Annotated[tuple[str, ...], Texts()]
    thickness: Metres
    webs: Annotated[tuple[Web, ...], Items(Web)] = ()
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("polygon",))] = "polygon"

    def __post_init__(self) -> None:
        if len(self.edge_walls) != len(self.corners):
            raise Refused("edge_walls", self.edge_walls, f"one wall name for each of the {len(self.corners)} edges")
        if not (self._area > 0.0 and np.all(np.hypot(*(np.roll(self.vertices, -1, axis=0) - self.vertices).T) > 0.0)):
            raise Refused("corners", self.corners, "distinct, go round counter-clockwise and enclose an area")
        if meets_itself(self.vertices):
            raise Refused("corners", self.corners, "those of a mid-line that neither crosses nor touches itself")
        self.check_walls()

    @property
    def vertices(self) -> Array:
        """(K, 2)."""
        return np.array(self.corners, dtype=float)

    @property
    def walls(self) -> tuple[str, ...]:
        """As given."""
        return self.edge_walls

    @property
    def thickness_limit(self) -> float:
        """4 area/perimeter: the diameter of the inscribed circle where one touches every edge, never less in a convex polygon."""
        lengths = np.hypot(*(np.roll(self.vertices, -1, axis=0) - self.vertices).T)
        return float(4.0 * self._area / lengths.sum())

    @property
    def _area(self) -> float:
        x, y = self.vertices.T
        return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
