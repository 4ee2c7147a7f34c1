"""Sections: polygonal single cells, and their stiffness matrices at many stations at once."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Instance, Number, Points, Refused, Text, Texts, checked, configuration
from beamenv.structure.model import checked_flow
from beamenv.structure.scale import in_scale
from beamenv.structure.section.inertia import SectionInertia
from beamenv.structure.section.mesh import ring
from beamenv.structure.section.properties import SectionProperties
from beamenv.structure.section.solid_sections import SolidSections
from beamenv.structure.walls.contour import Inlay, WallPoints, meets_itself, rotated, split_walls, wall_points
from beamenv.structure.walls.laminate import Laminate, Layup, WallLaw, wall_law
from beamenv.structure.walls.wall_kinematics import (
    GX,
    GY,
    PHI,
    SHEAR_THEORIES,
    TX,
    TY,
    LawTable,
    ShearFlow,
    W,
    motion_rows,
    shear_flow_of,
    strain_rows,
    transverse_shear_rows,
    transverse_shear_stiffness,
)

Array = NDArray[np.float64]

Metres = Annotated[float, Number(gt=0.0, unit="m")]
THEORY = Choice(SHEAR_THEORIES)

MOST_CORNERS = 1000
"""Of a polygon: more than any contour needs."""


class Section(ABC):
    """A closed single-cell thin-walled section with walls of one thickness."""

    thickness: float
    """m."""

    @property
    @abstractmethod
    def vertices(self) -> Array:
        """(K, 2): x, y (m) of the mid-line's corners at the root, counter-clockwise."""

    @property
    @abstractmethod
    def walls(self) -> tuple[str, ...]:
        """The wall that each of the K edges belongs to; edge k runs from vertex k to vertex k + 1."""

    @property
    def placed_vertices(self) -> Array:
        """(K, 2), m: the corners with the mid-line's centroid on the pitch axis, wherever their origin is."""
        vertices, length = self.vertices, self.edge_lengths
        return vertices - 0.5 * (length @ (vertices + np.roll(vertices, -1, axis=0))) / length.sum()

    @property
    def stays_plane(self) -> bool:
        """Whether a uniform wall does not warp in torsion: where its edges touch one circle about the centroid, as a tube's do."""
        start = self.placed_vertices
        end = np.roll(start, -1, axis=0)
        distance = (start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]) / self.edge_lengths
        return bool(np.ptp(distance) <= 1e-9 * np.abs(distance).max())

    @property
    def perimeter(self) -> float:
        """Length (m) of the mid-line."""
        return float(self.edge_lengths.sum())

    @property
    def edge_lengths(self) -> Array:
        """(K,), m."""
        return np.asarray(np.hypot(*(np.roll(self.vertices, -1, axis=0) - self.vertices).T))

    @property
    @abstractmethod
    def thickness_limit(self) -> float:
        """Wall thickness (m) at which the walls would fill the section."""

    def check_thickness(self, scale: float = 1.0, name: str = "thickness") -> None:
        """``ValueError`` unless the wall is thinner than its limit in a section of ``scale`` times the size."""
        limit = scale * self.thickness_limit
        if not self.thickness < limit:
            where = "" if scale == 1.0 else " at its narrow end"
            raise Refused(name, self.thickness, f"below {limit:.6g} m{where}, where walls meet")

    def wall_width(self, wall: str) -> float:
        """Length (m) along the contour of a wall; ``ValueError`` unless it is one straight edge."""
        checked("wall", wall, Text())
        edges = [k for k, name in enumerate(self.walls) if name == wall]
        if len(edges) != 1:
            raise Refused("wall", wall, f"one straight wall of the section: {', '.join(dict.fromkeys(self.walls))}")
        return float(self.edge_lengths[edges[0]])

    def stiffness(self, layup: Layup, shear: str = "first_order", shear_flow: str | None = None, model: str = "blade") -> Array:
        """Classical stiffness (4, 4) for (w', θx', θy', φ'): EA, EI_flap, EI_lag, GJ on the diagonal and the couplings.

        About the origin of the corners; no transverse force acts. Units N, N m, N m². In the blade's model that of ``properties``;
        in the thesis' by its wall kinematics, with ``shear`` and ``shear_flow`` as in a ``RotatingBeam`` (Berdichevsky, Armanios
        and Badir, Composites Engineering 2, 1992). Raises ``ValueError`` for an option that is unknown or not the model's, and
        for a lay-up of other walls.
        """
        checked("layup", layup, Instance(Layup)).check_walls(self.walls)
        checked("shear", shear, THEORY)
        flow = checked_flow(model, shear_flow)
        return self.properties(layup).classical_stiffness if model == "blade" else self._wall_stiffness(layup, shear, flow)

    def properties(self, layup: Layup) -> SectionProperties:
        """Stiffness with transverse shear, centres and inertia by solid finite elements, about the origin of the corners.

        Raises ``ValueError`` for a lay-up of other walls, for a wall too short for its thickness, and for one so thin (below some
        10⁻⁵ of the section's size) that rounding would be seen.
        """
        checked("layup", layup, Instance(Layup)).check_walls(self.walls)
        hosts = {wall: Laminate.equal_plies(layup.plies(wall), self.thickness) for wall in self.walls}
        elements = ring(self.vertices[None], self.walls, self.thickness)
        laminates = list(dict.fromkeys(hosts.values()))
        which = np.array([[laminates.index(hosts[edge.wall]) for edge in elements.edges]])
        with in_scale("section"):
            return SectionProperties.of(SolidSections.build(elements, laminates, which, pretwist=0.0))

    def _wall_stiffness(self, layup: Layup, shear: str, flow: str) -> Array:
        walls = SpanWalls.build(self, layup, z=np.zeros(1), scale=np.ones(1), angle=np.zeros(1), shear=shear, shear_flow=flow)
        full = walls.stiffness()[0]
        kept = [W, TX, TY, PHI]
        if shear == "rigid":
            return full[np.ix_(kept, kept)]
        shears = [GX, GY]
        return full[np.ix_(kept, kept)] - full[np.ix_(kept, shears)] @ np.linalg.solve(
            full[np.ix_(shears, shears)], full[np.ix_(shears, kept)]
        )


@configuration("section")
class BoxSection(Section):
    """A rectangular box: mid-line ``width`` along x, ``depth`` along y, wall ``thickness``, all in m.

    Its walls are right, top, left and bottom. Raises ``ValueError`` for a dimension that is not positive or a wall too thick.
    """

    width: Metres
    depth: Metres
    thickness: Metres

    def __post_init__(self) -> None:
        self.check_thickness()

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
class PolygonSection(Section):
    """Any closed polygon: corners (x, y) of the mid-line in m, counter-clockwise, the wall name of each edge, the wall thickness.

    Raises ``ValueError`` for fewer than three corners, two that coincide, a clockwise order, a mid-line that crosses or touches
    itself, a number of wall names other than that of the edges, or a wall too thick.
    """

    corners: Annotated[tuple[tuple[float, float], ...], Points(least=3, most=MOST_CORNERS, unit="m")]
    edge_walls: Annotated[tuple[str, ...], Texts()]
    thickness: Metres

    def __post_init__(self) -> None:
        if len(self.edge_walls) != len(self.corners):
            raise Refused("edge_walls", self.edge_walls, f"one wall name for each of the {len(self.corners)} edges")
        if not (self._area > 0.0 and np.all(self.edge_lengths > 0.0)):
            raise Refused("corners", self.corners, "distinct, go round counter-clockwise and enclose an area")
        if meets_itself(self.vertices):
            raise Refused("corners", self.corners, "those of a mid-line that neither crosses nor touches itself")
        self.check_thickness()

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
        return float(4.0 * self._area / self.perimeter)

    @property
    def _area(self) -> float:
        x, y = self.vertices.T
        return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


@dataclass(frozen=True, slots=True, eq=False)
class SpanWalls:
    """The walls at S stations of the span: geometry, laws and shear flow, ready to be integrated around the contour."""

    points: WallPoints
    laws: LawTable
    flow: ShearFlow
    shear: str

    @classmethod
    def build(
        cls,
        section: Section,
        layup: Layup,
        z: Array,
        scale: Array,
        angle: Array,
        shear: str,
        shear_flow: str,
        inlays: Sequence[Inlay] = (),
        cuts: Sequence[tuple[str, float]] = (),
    ) -> SpanWalls:
        """Walls at stations z (m) of a section scaled and turned (rad) station by station, with inlays let in.

        ``cuts`` are further (wall, width) at which walls are split, so that a patch without passive effect can be integrated over.
        """
        widths = [*cuts, *((inlay.wall, inlay.width) for inlay in inlays)]
        vertices, edges = split_walls(scale[:, None, None] * section.vertices, section.walls, widths)
        points = wall_points(rotated(vertices, angle), edges)
        hosts = {wall: Laminate.equal_plies(layup.plies(wall), section.thickness) for wall in section.walls}
        laws, index = lay_out_laws(hosts, points, inlays, z)
        table = LawTable.gather(laws, index)
        return cls(points=points, laws=table, flow=shear_flow_of(points, table, shear_flow), shear=shear)

    def strain_rows(self) -> Array:
        """(S, P, 6, 9)."""
        return strain_rows(self.points, self.flow, self.laws.thickness, self.shear)

    def stiffness(self) -> Array:
        """Section stiffness (S, 9, 9) for the generalised strains."""
        rows = self.strain_rows()
        weighted = self.points.ds[..., None, None] * (self.laws.stiffness @ rows)
        stations = len(rows)
        membrane = rows.reshape(stations, -1, 9).transpose(0, 2, 1) @ weighted.reshape(stations, -1, 9)
        if self.shear == "rigid":
            return membrane
        normal = transverse_shear_rows(self.points)
        weight = self.points.ds * transverse_shear_stiffness(self.laws, self.shear)
        return membrane + normal.transpose(0, 2, 1) @ (weight[..., None] * normal)

    def inertia(self) -> SectionInertia:
        """Section inertia matrices."""
        motion = motion_rows(self.points, self.flow, self.laws.thickness, self.shear)
        return SectionInertia.integrate(motion, self.laws.density, self.points.ds)


def lay_out_laws(
    hosts: dict[str, Laminate], points: WallPoints, inlays: Sequence[Inlay], z: Array
) -> tuple[list[WallLaw], NDArray[np.intp]]:
    """The distinct wall laws and, for every station and point (S, P), which one holds there."""
    known: dict[Laminate, int] = {}

    def number(laminate: Laminate) -> int:
        return known.setdefault(laminate, len(known))

    index = np.empty((len(z), len(points.edges)), dtype=np.intp)
    host = {wall: number(laminate) for wall, laminate in hosts.items()}
    index[:] = [host[edge.wall] for edge in points.edges]
    for inlay in inlays:
        law = number(hosts[inlay.wall].with_outer_layer(inlay.ply, inlay.thickness))
        under = [edge.lies_under(inlay) for edge in points.edges]
        index[np.ix_(inlay.covers(z), np.array(under))] = law
    return [wall_law(laminate) for laminate in known], np.repeat(index, 2, axis=1)
