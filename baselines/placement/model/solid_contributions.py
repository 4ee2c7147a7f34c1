"""What a patch adds to a blade of solid sections wherever it lies, about the steady state of the bare blade.

The energies of a covered section less those of a bare one act on the strains and increments that the bare blade has there, whose
shapes follow its beam strains as on the bare blade:

    ΔK = ∫ sᵀ ΔE s + eᵀ ΔD e − Ω² dᵀ ΔZ d dz + (added tension),    ΔM = ∫ dᵀ Δm d + aᵀ Δμ a dz,    ΔG = Ω ∫ dᵀ Δg d dz

with s the section's strains (e, a, a′) and d the increments of placement per coordinate. D is the stiffness of the stress that a
section carries in the steady state: it has the bare blade's resultants, whatever covers it, and with them the strains that suit
its own stiffness. Added mass pulls as in ``contributions``, along the span; one newton stiffens a section by its slopes and by
the spanwise stress that it raises.

Left out is what patches change beyond that: how far the blade untwists inboard of a place, how a section's shapes follow the
patch on it, and what the bare blade's higher modes add. On the default blade and its tapered kin, with a patch at the clamp and
pairs that overlap, frequencies are off by 0.04 % at most, B and C by 1.6 % of their largest, tr(P) and tr(S) by 0.9 %. On the
small CAS box, whose walls the patches stiffen by a third, it is 0.8 %, 2.1 % and 6.4 %, with sheets of PZT 0.6 %, 6 % and 6 %. R is
exact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.chebyshev import ChebyshevSpan
from beamenv.blade.config import BladeConfig
from beamenv.patches.operators import work_on_section
from beamenv.structure import RotatingBeam
from beamenv.structure.geometrically_exact.at_stations import SHAPE
from beamenv.structure.geometrically_exact.exact_beam import ExactBeam
from beamenv.structure.geometrically_exact.inertia import SpinningSections
from beamenv.structure.geometrically_exact.kinematics import FibreExtension, Placement, under_stress
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint
from beamenv.structure.geometrically_exact.rigid_theory import without_shear
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.geometrically_exact.tables import increment_rows
from beamenv.structure.section.elements import RIGID

Array = NDArray[np.float64]

CLASSICAL = slice(2, RIGID)
ALONG = np.eye(RIGID)[2]


@dataclass(frozen=True, slots=True, eq=False)
class SolidSamples:
    """Integrands of the blade's matrices at the nodes, (nodes, N, N), of one kind of section."""

    stiffness: Array
    """All but the tension that other patches add."""
    mass: Array
    gyroscopic: Array
    """Per rad/s."""
    per_tension: Array
    """Stiffness per newton of tension."""
    pull: Array
    """(nodes,): m (R₀ + z), kg."""
    forces: tuple[Array, Array]
    """(nodes, N) per volt and metre of an actuator and of a sensor."""
    energy: Array
    """(nodes,): twice what an actuator stores, J/V²/m."""


@dataclass(frozen=True, eq=False)
class BareBlade:
    """The bare blade at one speed at stations along the span, per coordinate of ``basis``."""

    exact: ExactBeam
    z: Array
    speed: float
    placement: Placement
    """That vibration is about."""
    increments: Array
    """d (S, 12, n)."""
    strains: Array
    """s (S, STRAINS, n)."""
    steady: Array
    """(S, STRAINS): strains of the steady state."""

    @classmethod
    def of(cls, exact: ExactBeam, point: OperatingPoint, z: Array, basis: Array) -> BareBlade:
        """At stations z (m), in coordinates basis (N, n)."""
        return cls(
            exact=exact,
            z=z,
            speed=point.speed,
            placement=exact.placement(z, exact.about(point)),
            increments=increment_rows(exact.space, z) @ basis,
            strains=exact.section_strains(z, point) @ basis,
            steady=exact.steady_strains(z, point),
        )

    def stress_stiffness(self, strain: Array, moments: Array) -> Array:
        """(S, 6, 6) per strain, of what carries ``strain`` (S, 6) and raises ``moments`` (S, 6, 6) per strain."""
        raised = np.einsum("sfi,si->sf", moments, strain)
        if self.exact.nonlinear:
            return FibreExtension.of(strain).stiffness(raised, moments)
        return under_stress(raised)


@dataclass(frozen=True, eq=False)
class Covering:
    """Sections under any combination of patches, and what a patch does to each."""

    config: BladeConfig
    sections: SectionsAlong
    work: tuple[tuple[SectionsAlong, Array], ...]
    """Work (V, STRAINS) per volt and metre, and on which sections, of an actuator and of a sensor."""

    @classmethod
    def of(cls, config: BladeConfig, bare: RotatingBeam, span: ChebyshevSpan) -> Covering:
        """Of a configuration, whose patches may lie in ``span``."""
        groups, half = config.patches.pair(), 0.5 * span.end
        places = zip(groups, (0.0, 0.5 * half), strict=True)  # every combination occurs somewhere
        inlays = [group.inlay(start, half) for group, start in places]
        covered = replace(bare, inlays=tuple(inlays) if groups[0].passive else ())
        work = tuple(work_on_section(covered, group.patch, inlay) for group, inlay in zip(groups, inlays, strict=True))
        return cls(config, covered.exact.sections, work)

    def bare(self, exact: ExactBeam) -> ExactBeam:
        """A bare blade of the same elements, and so of the same shapes, as the covered sections."""
        return replace(exact, sections=replace(self.sections, inlays=()))

    def samples(self, kind: int, bare: BareBlade) -> SolidSamples:
        """Of sections of one kind (0 bare, 1 top, 2 below, 3 both) along the whole span."""
        code, z = kind * self.config.patches.only("actuators").passive, bare.z
        solid = self.sections.solid

        def under(values: Array) -> Array:
            return self.sections.under(code, z, values)

        energy, stiffness, moments = under(elastic(bare, solid.energy)), under(solid.stiffness), under(solid.saint_venant_moments)
        inertia, shape_mass = under(solid.inertia), under(solid.shape_mass)
        resultants = self.sections.under(0, z, elastic(bare, solid.energy))[:, :RIGID] @ bare.steady[..., None]
        strain = np.asarray(np.linalg.solve(stiffness, resultants)[..., 0])
        arm = np.zeros((len(z), 3))
        arm[:, 2] = bare.exact.hub_radius + z
        spinning = SpinningSections.of(bare.placement, inertia, arm)
        rows = bare.placement.strain_rows @ bare.increments
        newton = np.concatenate([bare.placement.frame[:, 2], np.zeros((len(z), 3))], axis=-1)  # along the span
        strained = np.linalg.solve(stiffness, newton[..., None])[..., 0]
        return SolidSamples(
            stiffness=quadratic(bare.strains, energy)
            + quadratic(rows, bare.stress_stiffness(strain, moments))
            - bare.speed**2 * quadratic(bare.increments, spinning.centrifugal_softening),
            mass=quadratic(bare.increments, spinning.mass_form) + quadratic(bare.strains[:, SHAPE], shape_mass),
            gyroscopic=quadratic(bare.increments, spinning.gyroscopic),
            per_tension=quadratic(bare.increments, bare.placement.geometric(newton))
            + quadratic(rows, under_stress(np.einsum("sfi,si->sf", moments, strained))),
            pull=spinning.mass * (bare.exact.hub_radius + z),
            forces=self._forces(code, bare),
            energy=self._energy(code, bare),
        )

    def _forces(self, code: int, bare: BareBlade) -> tuple[Array, Array]:
        on_top, below = (np.einsum("sg,sgn->sn", sections.under(code, bare.z, work), bare.strains) for sections, work in self.work)
        return on_top, below

    def _energy(self, code: int, bare: BareBlade) -> Array:
        """As ``beamenv.patches.local_response`` has it."""
        sections, work = self.work[0]
        solid = sections.solid
        strain = np.einsum("vg,vgk->vk", work, solid.saint_venant)[:, CLASSICAL]
        stored = np.einsum("vk,vkl,vl->v", strain, solid.classical_stiffness, strain)
        return sections.under(code, bare.z, stored)


def elastic(bare: BareBlade, energy: Array) -> Array:
    """Energies (V, STRAINS, STRAINS) of sections as the blade's theory has them."""
    return without_shear(energy) if bare.exact.space.rigid else energy


def quadratic(rows: Array, section: Array) -> Array:
    """rowsᵀ section rows (nodes, n, n)."""
    return rows.transpose(0, 2, 1) @ (section @ rows)
