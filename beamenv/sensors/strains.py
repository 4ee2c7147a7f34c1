"""What strain gauges feel: the strain along their axis in the mean of a thin layer under their grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused, clause
from beamenv.patches import PatchLayout
from beamenv.patches.operators import CLASSICAL, LOCAL_STATIONS, stations_under, work_on_section
from beamenv.sensors.kinds import StrainGauge
from beamenv.structure import Lamina, RotatingBeam
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.stations import Stations
from beamenv.structure.walls.inlay import Inlay
from beamenv.structure.walls.laminate import Ply

Array = NDArray[np.float64]

LAYER = 0.01
"""Of the wall: the layer under the grid whose mean strain is read."""

_FOIL = Lamina.isotropic(E=1.0, nu=0.0, density=1.0)
"""Of no consequence: a gauge adds nothing to the blade."""


def footprint(beam: RotatingBeam, gauge: StrainGauge, name: str) -> Inlay:
    """The layer under a gauge; ``ValueError`` that calls it by ``name`` where it leaves the blade or its wall."""
    start = gauge.position - 0.5 * gauge.length
    try:
        thickness = LAYER * beam.section.thickness_of(gauge.wall)
        inlay = Inlay(gauge.wall, start, gauge.length, gauge.width, Ply(_FOIL, 0.0), thickness, gauge.offset, gauge.face)
        beam.room.check_fit(inlay)
    except ValueError as error:
        raise Refused(name, f"at {gauge.position:g} m on {gauge.wall}", f"on the blade and its walls: {clause(error)}") from None
    return inlay


def _stress(gauge: StrainGauge) -> tuple[float, float, float]:
    """(ss, zz, sz): what does the work ε along the gauge's axis per volume."""
    c, s = np.cos(np.radians(gauge.angle_deg)), np.sin(np.radians(gauge.angle_deg))
    return float(s * s), float(c * c), float(c * s)


def _work(beam: RotatingBeam, gauge: StrainGauge, inlay: Inlay) -> tuple[SectionsAlong, Array]:
    sections = beam.exact.cut_for(inlay.strip)
    low, high = inlay.depths(beam.section.thickness_of(inlay.wall))
    volume = inlay.width * (high - low) * inlay.length
    return sections, sections.solid.layer_force(inlay.strip, low, high, _stress(gauge)) / volume


def gauge_rows(beam: RotatingBeam, gauge: StrainGauge, inlay: Inlay, speed: float) -> Array:
    """(N,): the strain that a gauge shows per coefficient, of vibration about the steady state at ``speed`` (rad/s)."""
    sections, work = _work(beam, gauge, inlay)
    under = stations_under(beam, inlay.start, inlay.start + inlay.length)
    works = under.weight[:, None, None] * sections.at(under.z, work)[..., None]
    return np.asarray(beam.exact.generalised_force(under.z, beam.at(speed), works)[:, 0])


def local_strains(beam: RotatingBeam, layout: PatchLayout, gauge: StrainGauge, inlay: Inlay) -> Array:
    """(m,): the strain that a gauge shows per volt on each actuator of the blade at rest, exactly, as ``local_response`` has it."""
    sections, work = _work(beam, gauge, inlay)
    columns = []
    for group in layout.groups("actuators"):
        inlays = group.inlays("actuators", beam.length)
        theirs, push = work_on_section(beam, group.patch, inlays[0])
        shown = np.array([_overlap(beam, sections, work, inlay, theirs, push, each) for each in inlays])
        columns.append(shown.sum(keepdims=True) if group.ganged else shown)
    return np.concatenate(columns)


def _overlap(
    beam: RotatingBeam, sections: SectionsAlong, work: Array, inlay: Inlay, theirs: SectionsAlong, push: Array, patch: Inlay
) -> float:
    """∫ wᵀ C⁻¹ f dz where a gauge of the work w per strain lies over a patch of the resultants f."""
    start, end = max(inlay.start, patch.start), min(inlay.start + inlay.length, patch.start + patch.length)
    if end <= start:
        return 0.0
    stations = Stations.between(np.array([start, end]), LOCAL_STATIONS)

    def strain(own: SectionsAlong, done: Array) -> Array:
        along = np.einsum("vg,vgk->vk", done, own.solid.saint_venant)[:, CLASSICAL]
        return np.asarray(own.at(stations.z, along))

    stiffness = theirs.at(stations.z, theirs.solid.classical_stiffness)
    return float(np.einsum("s,sk,skl,sl->", stations.weight, strain(sections, work), stiffness, strain(theirs, push)))
