"""Generalised forces per volt and charges per generalised coordinate (thesis Eqs. 4.18, 4.34–4.39, from the energy)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from beamenv.patches.layout import ACTUATOR_WALL, SENSOR_WALL, PatchLayout
from beamenv.patches.material import PatchMaterial
from beamenv.structure.assembly import generalised_strains
from beamenv.structure.beam import EXTRA_STATIONS, RotatingBeam, check_fit
from beamenv.structure.trial_functions import Stations

Array = NDArray[np.float64]


def force_per_span(beam: RotatingBeam, patch: PatchMaterial, wall: str, width: float, z: Array) -> Array:
    """Generalised force (S, N) per volt and per metre of a patch at stations z (m) that it covers.

    The condensed piezoelectric resultants times every strain row of the wall (thesis Eq. 4.18, from the energy).
    """
    walls = beam.walls_at(z, cuts=((wall, width),))
    under = [edge.wall == wall and edge.reach <= 0.5 * width * (1.0 + 1e-9) for edge in walls.points.edges]
    covered = np.repeat(under, 2)
    resultants = patch.wall_resultants(beam.section.thickness, walls.laws.hoop_coupling[:, covered])
    per_strain = np.einsum("sp,spk,spkg->sg", walls.points.ds[:, covered], resultants, walls.strain_rows()[:, covered])
    strains = generalised_strains(beam.space.evaluate(z))
    return np.asarray(np.einsum("sg,sgn->sn", per_strain, strains))


def patch_force(beam: RotatingBeam, patch: PatchMaterial, wall: str, start: float, length: float, width: float) -> Array:
    """Generalised force (N,) per volt of one patch.

    ``ValueError`` for a patch that leaves the blade or does not fit its wall.
    """
    return patch_forces(beam, patch, wall, (start,), length, width)[:, 0]


def patch_forces(
    beam: RotatingBeam, patch: PatchMaterial, wall: str, starts: Sequence[float], length: float, width: float
) -> Array:
    """Generalised force (N, k) per volt of each of k patches on one wall.

    ``ValueError`` for a patch that leaves the blade or does not fit its wall.
    """
    for start in starts:
        check_fit(beam, patch.inlay(wall, start, length, width))
    under = [stations_under(beam, start, start + length) for start in starts]
    per_span = force_per_span(beam, patch, wall, width, np.concatenate([stations.z for stations in under]))
    ends = np.cumsum([len(stations.z) for stations in under])
    return np.column_stack([stations.weight @ part for stations, part in zip(under, np.split(per_span, ends[:-1]), strict=True)])


def stations_under(beam: RotatingBeam, start: float, end: float) -> Stations:
    """Stations along a patch from ``start`` to ``end`` (m)."""
    edges = [edge for inlay in beam.inlays for edge in (inlay.start, inlay.start + inlay.length) if start < edge < end]
    breakpoints = np.unique([start, *edges, end])  # a patch on the opposite wall changes the shear flow where it ends
    apart = np.append(True, np.diff(breakpoints) > 1e-9 * beam.length)
    return Stations.between(breakpoints[apart], beam.terms + EXTRA_STATIONS)


def actuation(beam: RotatingBeam, layout: PatchLayout) -> Array:
    """F: generalised force per volt, (N, actuators), or (N, 1) when ganged; ``beam`` carries the inlays of passive patches."""
    starts = layout.actuator_positions(beam.length)
    forces = patch_forces(beam, layout.patch, ACTUATOR_WALL, starts, layout.length, layout.width)
    return forces.sum(axis=1, keepdims=True) if layout.ganged else forces


def sensing(beam: RotatingBeam, layout: PatchLayout) -> Array:
    """C_s: charge (C) of each sensor per generalised coordinate, (sensors, N); times q̇ it is the sensed current (Eq. 4.38)."""
    starts = layout.sensor_positions(beam.length)
    forces = patch_forces(beam, layout.patch, SENSOR_WALL, starts, layout.length, layout.width)
    return layout.patch.charge_per_reaction * forces.T
