"""Generalised forces per volt and charges per generalised coordinate (thesis Eqs. 4.18, 4.34–4.39, from the energy)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Instance, checked
from beamenv.configuration.read_only import Sealed
from beamenv.patches.group import PatchGroup
from beamenv.patches.layout import SIDES, PatchLayout
from beamenv.patches.material import PatchMaterial
from beamenv.structure.assembly import generalised_strains, symmetric
from beamenv.structure.beam import EXTRA_STATIONS, RotatingBeam
from beamenv.structure.geometrically_exact.exact_beam import ExactBeam
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.stations import LEAST, Stations
from beamenv.structure.walls.inlay import Inlay, Strip

Array = NDArray[np.float64]

CLASSICAL = slice(2, 6)
"""Extension, bending and twist among the section's resultants; of transverse shear a patch raises none."""

LOCAL_STATIONS = 4
"""Gauss stations on each piece of a patch: its strains hardly change along it."""


def force_per_span(beam: RotatingBeam, patch: PatchMaterial, strip: Strip, z: Array) -> Array:
    """Generalised force (S, N) per volt and per metre of a patch at stations z (m) that it covers, in the thesis' model.

    The condensed piezoelectric resultants times every strain row of the wall (thesis Eq. 4.18, from the energy).
    """
    walls = beam.walls_at(z, cuts=(strip,))
    covered = np.repeat([strip in edge.strips for edge in walls.points.edges], 2)
    resultants = patch.wall_resultants(beam.section.thickness, walls.laws.hoop_coupling[:, covered])
    per_strain = np.einsum("sp,spk,spkg->sg", walls.points.ds[:, covered], resultants, walls.strain_rows()[:, covered])
    strains = generalised_strains(beam.space.evaluate(z))
    return np.asarray(np.einsum("sg,sgn->sn", per_strain, strains))


def work_on_section(beam: RotatingBeam, patch: PatchMaterial, inlay: Inlay) -> tuple[SectionsAlong, Array]:
    """The sections of a blade, and the work (V, STRAINS) per volt and metre of a patch where an inlay is on each one's strains."""
    sections, patch = beam.exact.cut_for(inlay.strip), as_hot_as(beam, patch, inlay)
    low, high = inlay.depths(beam.section.thickness_of(inlay.wall))
    hoop, span, shear = (patch.stress_in_wall(inlay.ply.angle_deg) / patch.electrode_spacing).tolist()
    return sections, sections.solid.layer_force(inlay.strip, low, high, (hoop, span, shear))


def charge_per_kelvin(beam: RotatingBeam, group: PatchGroup) -> Array:
    """(channels,), C/K: what sensor patches give that warm with a blade which nothing holds, counted as ``sensing`` counts.

    p A of a sheet free to expand, and of what the blade strains it otherwise the piezoelectric charge.
    """
    inlays = group.inlays("sensors", beam.length)
    each = np.array([_charge_of_one(beam, group.patch, inlay) for inlay in inlays])
    return _by_channel(each[None], group)[0]


def _charge_of_one(beam: RotatingBeam, patch: PatchMaterial, inlay: Inlay) -> float:
    sections, warm = beam.exact.cut_for(inlay.strip), as_hot_as(beam, patch, inlay)
    low, high = inlay.depths(beam.section.thickness_of(inlay.wall))
    hoop, span, shear = (warm.stress_in_wall(inlay.ply.angle_deg) / warm.electrode_spacing).tolist()
    under = stations_under(beam, inlay.start, inlay.start + inlay.length)
    work = sections.solid.layer_work_by_heat(inlay.strip, low, high, (hoop, span, shear))[:, 0]
    strained = float(under.weight @ sections.at(under.z, work)) * warm.charge_per_reaction
    area = inlay.length * inlay.width
    return patch.pyroelectric * area + strained - area * float(warm.piezoelectric_stress() @ np.array(warm.lamina.expansion))


def as_hot_as(beam: RotatingBeam, patch: PatchMaterial, inlay: Inlay) -> PatchMaterial:
    """A sheet at the temperature that a blade has in the middle of an inlay."""
    if beam.temperatures is None:
        return patch
    middle = np.array([inlay.start + 0.5 * inlay.length])
    return patch.at(float(beam.planform.temperature(middle)[0]))


def patch_force(
    beam: RotatingBeam, patch: PatchMaterial, wall: str, start: float, length: float, width: float, speed: float = 0.0
) -> Array:
    """Generalised force (N,) per volt of one patch.

    ``ValueError`` for a patch that leaves the blade or does not fit its wall.
    """
    return patch_forces(beam, patch, [patch.inlay(wall, start, length, width)], speed)[:, 0]


def patch_forces(beam: RotatingBeam, patch: PatchMaterial, inlays: Sequence[Inlay], speed: float = 0.0) -> Array:
    """Generalised force (N, k) per volt of each of k patches that take the places of inlays of one kind.

    ``ValueError`` for a patch that leaves the blade or does not fit its wall.
    """
    for inlay in inlays:
        beam.room.check_fit(inlay)
    if beam.model == "blade":
        return _forces_about(beam, beam.exact, beam.at(speed), patch, inlays)
    under = _stations_under_each(beam, inlays)
    per_span = force_per_span(beam, patch, inlays[0].strip, np.concatenate([stations.z for stations in under]))
    ends = np.cumsum([len(stations.z) for stations in under])
    return np.column_stack([stations.weight @ part for stations, part in zip(under, np.split(per_span, ends[:-1]), strict=True)])


def _stations_under_each(beam: RotatingBeam, inlays: Sequence[Inlay]) -> list[Stations]:
    return [stations_under(beam, inlay.start, inlay.start + inlay.length) for inlay in inlays]


def _forces_about(
    beam: RotatingBeam, exact: ExactBeam, point: OperatingPoint, patch: PatchMaterial, inlays: Sequence[Inlay]
) -> Array:
    """(N, k): as ``patch_forces``, of a blade as it stands at a point."""
    if beam.temperature_table is not None and len(inlays) > 1:  # each is as hot as the blade where it is
        return np.hstack([_forces_about(beam, exact, point, patch, [inlay]) for inlay in inlays])
    under = _stations_under_each(beam, inlays)
    sections, work = work_on_section(beam, patch, inlays[0])
    z, weight = (np.concatenate([getattr(stations, name) for stations in under]) for name in ("z", "weight"))
    each = np.repeat(np.eye(len(under)), [len(stations.z) for stations in under], axis=0)
    works = (weight[:, None] * sections.at(z, work))[..., None] * each[:, None]
    return exact.generalised_force(z, point, works)


def stations_under(beam: RotatingBeam, start: float, end: float) -> Stations:
    """Stations along a patch from ``start`` to ``end`` (m)."""
    edges = [edge for inlay in beam.inlays for edge in (inlay.start, inlay.start + inlay.length) if start < edge < end]
    breakpoints = np.unique([start, *edges, end])  # a patch on the opposite wall changes the shear flow where it ends
    apart = np.append(True, np.diff(breakpoints) > 1e-9 * beam.length)
    few = int(np.ceil(LEAST + (beam.space.order + EXTRA_STATIONS) * (end - start) / beam.length))
    return beam.space.stations(breakpoints[apart], few if beam.model == "blade" else beam.space.order + EXTRA_STATIONS)


def _check_parts(beam: RotatingBeam, layout: PatchLayout) -> None:
    checked("beam", beam, Instance(RotatingBeam))
    checked("layout", layout, Instance(PatchLayout))


def actuation(beam: RotatingBeam, layout: PatchLayout, speed: float = 0.0) -> Array:
    """F: generalised force per volt, (N, actuators), or (N, 1) when ganged; ``beam`` carries the inlays of passive patches and
    vibrates about its steady state at ``speed`` rad/s.
    """
    _check_parts(beam, layout)
    return _actuation(beam, layout, lambda patch, inlays: patch_forces(beam, patch, inlays, speed))


def sensing(beam: RotatingBeam, layout: PatchLayout, speed: float = 0.0) -> Array:
    """C_s: charge (C) of each sensor per generalised coordinate, (sensors, N); times q̇ it is the sensed current (Eq. 4.38)."""
    _check_parts(beam, layout)
    return _sensing(beam, layout, lambda patch, inlays: patch_forces(beam, patch, inlays, speed))


Forces = Callable[[PatchMaterial, Sequence[Inlay]], Array]


def _actuation(beam: RotatingBeam, layout: PatchLayout, forces: Forces) -> Array:
    groups = layout.groups("actuators")
    return np.hstack([_by_channel(forces(group.patch, group.inlays("actuators", beam.length)), group) for group in groups])


def _sensing(beam: RotatingBeam, layout: PatchLayout, forces: Forces) -> Array:
    groups = layout.groups("sensors")
    reactions = [_by_channel(forces(group.patch, group.inlays("sensors", beam.length)), group) for group in groups]
    charges = [group.patch.charge_per_reaction * reaction.T for group, reaction in zip(groups, reactions, strict=True)]
    return np.vstack(charges) if charges else np.zeros((0, beam.space.size))


def _by_channel(forces: Array, group: PatchGroup) -> Array:
    return forces.sum(axis=1, keepdims=True) if group.ganged else forces


@dataclass(frozen=True, slots=True, eq=False)
class PatchResponse(Sealed):
    """What voltages on the patches do to the blade at rest."""

    energy: Array
    """(m, m), J/V²: twice the energy that the actuators store."""
    charges: Array
    """(p, m), C/V: what the sensors show of it."""
    smooth_charges: Array
    """(p, m), C/V: what the trial functions can follow of that, C_s K_e⁻¹F."""


def local_response(beam: RotatingBeam, layout: PatchLayout) -> PatchResponse:
    """FᵀK_e⁻¹F and C_s K_e⁻¹F of the blade at rest, exactly, however short its patches are.

    Stresses that a patch raises in a cantilever balance within each section, so that its strains C⁻¹f are where the patch is and
    nowhere else, f (4,) being its stress resultants and C the section's classical stiffness: ∫ f_iᵀ C⁻¹ f_j dz over the span
    that two patches share. (That of a section's end effects, a share of some per cent at the ends of a patch, is left out.) What
    springs at the tip and heat change of it the trial functions follow.
    """
    groups = [(side, group, group.inlays(side, beam.length)) for side in SIDES for group in layout.groups(side)]
    edges = [edge for _, _, inlays in groups for inlay in inlays for edge in (inlay.start, inlay.start + inlay.length)]
    stations = Stations.between(beam.breakpoints(edges), LOCAL_STATIONS)
    strains, shares = [], []
    for side, group, inlays in groups:
        for alike in [[inlay] for inlay in inlays] if beam.temperature_table is not None else [inlays]:
            sections, work = work_on_section(beam, group.patch, alike[0])
            strain = sections.at(stations.z, np.einsum("vg,vgk->vk", work, sections.solid.saint_venant)[:, CLASSICAL])
            strains += [strain * inlay.covers(stations.z)[:, None] for inlay in alike]
        share = 1.0 if side == "actuators" else group.patch.charge_per_reaction
        shares.append(share * _by_channel(np.eye(len(inlays)), group))
    sections = beam.exact.sections
    stiffness = sections.at(stations.z, sections.solid.classical_stiffness)
    each = np.stack(strains, axis=-1)  # (S, 4, patches): C⁻¹f
    whole = np.einsum("s,ski,skl,slj->ij", stations.weight, each, stiffness, each, optimize=True)
    by_channel = _side_by_side(shares)
    whole = by_channel.T @ whole @ by_channel
    m = layout.channels("actuators")
    forces, charges = actuation(beam, layout), sensing(beam, layout)
    static = np.linalg.solve(beam.at(0.0).stiffness, forces)
    smooth = charges @ static
    energy, shown = whole[:m, :m], whole[m:, :m]
    if beam.exact.loaded_at_rest:
        free_energy, free_charges = _of_free_cantilever(beam, layout)
        energy, shown = energy + symmetric(forces.T @ static) - free_energy, shown + smooth - free_charges
    return PatchResponse(energy, shown, smooth)


def _of_free_cantilever(beam: RotatingBeam, layout: PatchLayout) -> tuple[Array, Array]:
    """FᵀK⁻¹F and C_s K⁻¹F of the sections' blade without springs and thermal strain, by the trial functions."""
    exact = replace(beam.exact, heat=None, springs=None)
    point = exact.at(0.0)

    def about(patch: PatchMaterial, inlays: Sequence[Inlay]) -> Array:
        return _forces_about(beam, exact, point, patch, inlays)

    forces, charges = _actuation(beam, layout, about), _sensing(beam, layout, about)
    static = np.linalg.solve(point.stiffness, forces)
    return symmetric(forces.T @ static), charges @ static


def _side_by_side(blocks: Sequence[Array]) -> Array:
    """A matrix with blocks on its diagonal."""
    rows, columns = (np.cumsum([0, *(block.shape[axis] for block in blocks)]) for axis in (0, 1))
    whole = np.zeros((rows[-1], columns[-1]))
    for block, row, column in zip(blocks, rows[:-1], columns[:-1], strict=True):
        whole[row : row + len(block), column : column + block.shape[1]] = block
    return whole
