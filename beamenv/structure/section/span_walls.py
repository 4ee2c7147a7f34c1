"""The walls of a closed cell by the thesis' kinematics, at many stations of the span at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.section.inertia import SectionInertia
from beamenv.structure.walls.contour import WallPoints, rotated, split_walls, wall_points
from beamenv.structure.walls.inlay import Inlay, Strip
from beamenv.structure.walls.laminate import Laminate, WallLaw, wall_law
from beamenv.structure.walls.wall_kinematics import (
    GX,
    GY,
    PHI,
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
        vertices: Array,
        hosts: dict[str, Laminate],
        walls: Sequence[str],
        z: Array,
        scale: Array,
        angle: Array,
        shear: str,
        shear_flow: str,
        inlays: Sequence[Inlay] = (),
        cuts: Sequence[Strip] = (),
    ) -> SpanWalls:
        """Walls at stations z (m) of a section with ``vertices`` (K, 2), scaled and turned (rad) station by station, with inlays.

        ``cuts`` are further strips at which walls are split, so that a patch without passive effect can be integrated over.
        """
        strips = [*cuts, *(inlay.strip for inlay in inlays)]
        split, edges = split_walls(scale[:, None, None] * vertices, walls, strips)
        points = wall_points(rotated(split, angle), edges)
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
        law = number(inlay.let_into(hosts[inlay.wall]))
        under = [edge.lies_under(inlay) for edge in points.edges]
        index[np.ix_(inlay.covers(z), np.array(under))] = law
    return [wall_law(laminate) for laminate in known], np.repeat(index, 2, axis=1)


def classical(stiffness: Array, rigid: bool) -> Array:
    """(4, 4) for (w', θx', θy', φ') of (9, 9), with no transverse force; or without shear."""
    kept = [W, TX, TY, PHI]
    if rigid:
        return stiffness[np.ix_(kept, kept)]
    shears = [GX, GY]
    return stiffness[np.ix_(kept, kept)] - stiffness[np.ix_(kept, shears)] @ np.linalg.solve(
        stiffness[np.ix_(shears, shears)], stiffness[np.ix_(shears, kept)]
    )
