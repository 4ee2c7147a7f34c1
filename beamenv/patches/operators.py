"""Generalised forces per volt and charges per generalised coordinate (thesis Eqs. 4.18, 4.34–4.39, from the energy)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.patches.layout import ACTUATOR_WALL, SENSOR_WALL, PatchLayout
from beamenv.patches.material import PatchMaterial
from beamenv.structure.assembly import generalised_strains
from beamenv.structure.beam import EXTRA_STATIONS, RotatingBeam, check_fit
from beamenv.structure.trial_functions import Stations

Array = NDArray[np.float64]


def patch_force(beam: RotatingBeam, patch: PatchMaterial, wall: str, start: float, length: float, width: float) -> Array:
    """Generalised force (N,) per volt of one patch: its condensed piezoelectric resultants times every strain row of the wall.

    ``ValueError`` for a patch that leaves the blade or does not fit its wall.
    """
    check_fit(beam, patch.inlay(wall, start, length, width))
    stations = Stations.between(np.array([start, start + length]), beam.terms + EXTRA_STATIONS)
    walls = beam.walls_at(stations.z, cuts=((wall, width),))
    under = [edge.wall == wall and edge.reach <= 0.5 * width * (1.0 + 1e-9) for edge in walls.points.edges]
    covered = np.repeat(under, 2)
    resultants = patch.wall_resultants(beam.section.thickness, walls.laws.hoop_coupling[:, covered])
    per_strain = np.einsum("sp,spk,spkg->sg", walls.points.ds[:, covered], resultants, walls.strain_rows()[:, covered])
    strains = generalised_strains(beam.space.evaluate(stations.z))
    return np.asarray(np.einsum("s,sg,sgn->n", stations.weight, per_strain, strains))


def actuation(beam: RotatingBeam, layout: PatchLayout) -> Array:
    """F: generalised force per volt, (N, actuators), or (N, 1) when ganged; ``beam`` carries the inlays of passive patches."""
    columns = [
        patch_force(beam, layout.patch, ACTUATOR_WALL, start, layout.length, layout.width)
        for start in layout.actuator_positions(beam.length)
    ]
    forces = np.column_stack(columns)
    return forces.sum(axis=1, keepdims=True) if layout.ganged else forces


def sensing(beam: RotatingBeam, layout: PatchLayout) -> Array:
    """C_s: charge (C) of each sensor per generalised coordinate, (sensors, N); times q̇ it is the sensed current (Eq. 4.38)."""
    rows = [
        patch_force(beam, layout.patch, SENSOR_WALL, start, layout.length, layout.width)
        for start in layout.sensor_positions(beam.length)
    ]
    return layout.patch.charge_per_reaction * np.stack(rows)
