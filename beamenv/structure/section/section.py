"""What every section has in common: its walls' mid-lines, its stiffness and its inertia."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Instance, Number, Refused, Text, checked
from beamenv.configuration.near import meant
from beamenv.structure.model import checked_flow
from beamenv.structure.scale import in_scale
from beamenv.structure.section.corners import check_corners
from beamenv.structure.section.mesh import Mesh, mesh
from beamenv.structure.section.properties import SectionProperties
from beamenv.structure.section.solid_sections import SolidSections
from beamenv.structure.section.span_walls import SpanWalls, classical
from beamenv.structure.walls.chain import Chain
from beamenv.structure.walls.inlay import Strip
from beamenv.structure.walls.laminate import Laminate, Layup
from beamenv.structure.walls.wall_kinematics import SHEAR_THEORIES

Array = NDArray[np.float64]

Metres = Annotated[float, Number(gt=0.0, unit="m")]
THEORY = Choice(SHEAR_THEORIES)

REMEMBERED = 32
"""Sections of which the walls' widths and the elements are."""


class Section(ABC):
    """A thin-walled section, closed or open, of one cell or more.

    It is its walls' mid-lines: one chain of walls, ``vertices`` and ``walls``, and whatever ``further`` ones stand on it.
    """

    thickness: float
    """m, of walls that have none of their own."""
    closed = True
    """Whether the first chain closes."""
    drawn_by: ClassVar[str] = "width"
    """The field that says where corners are."""

    @property
    def own_thicknesses(self) -> dict[str, float]:
        """m, of walls that have one of their own."""
        return {}

    @property
    @abstractmethod
    def vertices(self) -> Array:
        """(K, 2): x, y (m) of the mid-line's corners at the root, counter-clockwise if it closes."""

    @property
    @abstractmethod
    def walls(self) -> tuple[str, ...]:
        """The wall that each of the edges belongs to; edge k runs from vertex k to vertex k + 1."""

    @property
    def further(self) -> tuple[Chain, ...]:
        """Walls that end on those of the first chain, or on one another."""
        return ()

    @property
    def chains(self) -> tuple[Chain, ...]:
        """All its walls."""
        return Chain(self.vertices, self.walls, tuple(map(self.thickness_of, self.walls)), self.closed), *self.further

    @property
    def wall_names(self) -> tuple[str, ...]:
        """Of all walls, each once."""
        return tuple(dict.fromkeys(wall for chain in self.chains for wall in chain.walls))

    def thickness_of(self, wall: str) -> float:
        """M."""
        return self.own_thicknesses.get(wall, self.thickness)

    def hosts(self, layup: Layup) -> dict[str, Laminate]:
        """The laminate of each wall."""
        return {wall: Laminate.equal_plies(layup.plies(wall), self.thickness_of(wall)) for wall in self.wall_names}

    @property
    def placed_chains(self) -> tuple[Chain, ...]:
        """All walls, with the mid-line's centroid on the pitch axis, wherever their origin is."""
        chains = self.chains
        total = sum(float(chain.lengths.sum()) for chain in chains)
        centroid = sum((chain.first_moments for chain in chains), np.zeros(2)) / total
        return tuple(chain.shifted(-centroid) for chain in chains)

    @property
    def least_extent(self) -> float:
        """m: the smaller of its mid-lines' extents, or the thickness; from about so far from the clamp it is a beam."""
        points = np.concatenate([chain.points for chain in self.chains])
        return float(min(max(extent, self.thickness) for extent in np.ptp(points, axis=0)))

    @property
    def stays_plane(self) -> bool:
        """Whether a uniform wall does not warp in torsion: where its edges touch one circle about the centroid, as a tube's do."""
        if not self.closed or self.further or self.own_thicknesses:
            return False
        placed = self.placed_chains[0]
        start, end = placed.starts, placed.ends
        distance = (start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]) / placed.lengths
        return bool(np.ptp(distance) <= 1e-9 * np.abs(distance).max())

    @property
    def perimeter(self) -> float:
        """Length (m) of all mid-lines."""
        return sum(float(chain.lengths.sum()) for chain in self.chains)

    @property
    def thickness_limit(self) -> float:
        """Wall thickness (m) at which the walls would fill the section."""
        return np.inf

    def check_thickness(self, scale: float = 1.0, name: str = "thickness") -> None:
        """``ValueError`` unless the walls are thinner than their limit in a section of ``scale`` times the size."""
        limit = scale * self.thickness_limit
        thickest = max(self.thickness, *self.own_thicknesses.values(), 0.0)
        if not thickest < limit:
            where = "" if scale == 1.0 else " at its narrow end"
            raise Refused(name, thickest, f"below {limit:.6g} m{where}, where walls meet")

    def check_corners(self, scale: float = 1.0, path: str = "") -> None:
        """``ValueError`` for corners too sharp, or that leave nothing of a piece in a section of ``scale`` times the size."""
        check_corners(self.chains, self.drawn_by, scale, path)

    def wall_width(self, wall: str) -> float:
        """Length (m) along the contour of a wall; ``ValueError`` unless it is in one part."""
        width = _widths(self).get(checked("wall", wall, Text()))
        if width is None:
            names = self.wall_names
            raise Refused("wall", wall, f"one wall of the section: {', '.join(names)}", meant(wall, names))
        return width

    def stiffness(self, layup: Layup, shear: str = "first_order", shear_flow: str | None = None, model: str = "blade") -> Array:
        """Classical stiffness (4, 4) for (w', θx', θy', φ'): EA, EI_flap, EI_lag, GJ on the diagonal and the couplings.

        About the origin of the corners; no transverse force acts. Units N, N m, N m². In the blade's model that of ``properties``;
        in the thesis' by its wall kinematics, with ``shear`` and ``shear_flow`` as in a ``RotatingBeam`` (Berdichevsky, Armanios
        and Badir, Composites Engineering 2, 1992). Raises ``ValueError`` for an option that is unknown or not the model's, for
        a lay-up of other walls, and for a section that the thesis' model has not.
        """
        checked("layup", layup, Instance(Layup)).check_walls(self.wall_names)
        checked("shear", shear, THEORY)
        flow = checked_flow(model, shear_flow)
        if model == "blade":
            return self.properties(layup).classical_stiffness
        self.check_one_cell()
        walls = self.walls_at(self.hosts(layup), z=np.zeros(1), scale=np.ones(1), angle=np.zeros(1), shear=shear, shear_flow=flow)
        return classical(walls.stiffness()[0], shear == "rigid")

    def check_one_cell(self) -> None:
        """``ValueError`` for a section that the thesis' model has not: open, of several cells or thicknesses."""
        if not self.closed or self.further or self.own_thicknesses:
            raise ValueError("section must be closed, of one cell and of one wall thickness in the thesis' model.")

    def walls_at(self, hosts: dict[str, Laminate], **options: Any) -> SpanWalls:
        """Its walls at stations of the span by the thesis' kinematics; options as in ``SpanWalls.build``."""
        return SpanWalls.build(self.vertices, hosts, self.walls, **options)

    def properties(self, layup: Layup, size: float = 1.0) -> SectionProperties:
        """Stiffness with transverse shear, centres and inertia by solid finite elements, about the origin of the corners; of the
        section ``size`` times as large, with walls as thick.

        Raises ``ValueError`` for a lay-up of other walls, for a wall too short for its thickness, and for one so thin (below some
        10⁻⁵ of the section's size) that rounding would be seen.
        """
        checked("layup", layup, Instance(Layup)).check_walls(self.wall_names)
        hosts = self.hosts(layup)
        elements = mesh(self.chains, np.array([checked("size", size, Number(gt=0.0))]))
        laminates = list(dict.fromkeys(hosts.values()))
        which = np.array([[laminates.index(hosts[edge.wall]) for edge in elements.edges]])
        with in_scale("section"):
            return SectionProperties.of(SolidSections.build(elements, laminates, which, pretwist=0.0))


@lru_cache(maxsize=REMEMBERED)
def _widths(section: Section) -> dict[str, float]:
    """Length (m) of each wall that is in one part."""
    found: dict[str, float] = {}
    for chain in section.chains:
        for wall in dict.fromkeys(chain.walls):
            part = chain.part(wall)
            if part is not None and wall not in found:
                found[wall] = float(chain.lengths[part[0] : part[1]].sum())
    return found


@lru_cache(maxsize=REMEMBERED)
def mesh_of(section: Section, sizes: tuple[float, ...], strips: tuple[Strip, ...], needed: tuple[bool, ...]) -> Mesh:
    """As ``mesh`` of the section's ``placed_chains``: blades of other plies, as those of a bank are, share it."""
    return mesh(section.placed_chains, np.array(sizes), strips, np.array(needed))
