"""The blade model's matrices: M, K and G at a speed, about the steady state there, with the sections' warping eliminated.

The coefficients q are those of the reference line and the sections' turns, (u, v, s, θx, θy, φ). A section's shapes have
amplitudes a(z) of their own, zero at the clamp, which have next to no inertia: for given strains e(z) of the beam they take the
values of least energy, a = −K_aa⁻¹ ∫(Φᵀ E_ae + Φ′ᵀ E_a′e) e dz, and move with q (Guyan's reduction, whose mass they keep).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from beamenv.configuration import Refused
from beamenv.structure.assembly import BeamMatrices, symmetric
from beamenv.structure.geometrically_exact.inertia import SpinningSections
from beamenv.structure.geometrically_exact.kinematics import INCREMENT, SPIN, FibreExtension, Placement, under_stress
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint, SteadyState
from beamenv.structure.geometrically_exact.rotations import rotation, rotation_vector
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.section.elements import RIGID
from beamenv.structure.section.solid_sections import AMPLITUDES, STRAINS
from beamenv.structure.trial_functions import Stations, TrialSpace, polynomial_table

Array = NDArray[np.float64]

BEAM, SHAPE, SHAPE_SLOPE = slice(0, RIGID), slice(RIGID, RIGID + AMPLITUDES), slice(RIGID + AMPLITUDES, STRAINS)

ITERATIONS = 30
"""Most Newton steps to the steady state; five or six do."""

CONVERGED = 1e-4
"""Largest increment, m or rad, after which no further step is made: steps shrink as their squares, so the next were of 1e-9."""

HELD = 1e-10
"""Share of the stiffest shape's energy that every shape is given, so that one that does not warp at all has an amplitude too."""


@dataclass(frozen=True, eq=False)
class ExactBeam:
    """A blade, its sections along the span, and the stations at which it is integrated."""

    space: TrialSpace
    stations: Stations
    sections: SectionsAlong
    hub_radius: float
    nonlinear: bool
    """Whether vibration is about the non-linear steady state, or about the blade at rest under the stresses of a linear one."""

    def rows(self, z: Array) -> Array:
        """(S, 12, N): [u, c, u′, c′] at stations z (m)."""
        tables = self.space.evaluate(z)
        order = ("u", "v", "s", "theta_x", "theta_y", "phi")
        return np.stack([tables[name, derivative] for derivative in (0, 1) for name in order], axis=1)

    def shape_tables(self, z: Array) -> tuple[Array, Array]:
        """Values and slopes (S, terms) of the amplitudes' trial functions."""
        value, slope, _ = polynomial_table(z / self.space.length, 1, self.space.terms, self.space.length)
        return value, slope

    def placement(self, z: Array, coefficients: Array) -> Placement:
        """Where the blade is at stations z."""
        return Placement.of(self.rows(z) @ coefficients, self.sections.planform.frames(z))

    def section_strains(self, z: Array, point: OperatingPoint) -> Array:
        """(S, STRAINS, N): strains of the sections at stations z (m) per coefficient, of vibration about the steady state."""
        at = self._at
        coefficients = self.about(point)
        beam = self.placement(z, coefficients).strain_rows @ self.rows(z)
        follow = at.amplitudes(self.placement(self.stations.z, coefficients).strain_rows @ at.rows)
        return self._with_shapes(z, beam, follow)

    def steady_strains(self, z: Array, point: OperatingPoint) -> Array:
        """(S, STRAINS): strains of the sections at stations z (m) in the steady state."""
        assert point.steady is not None
        if self.about(point).any():
            beam = self.placement(z, point.steady.coefficients).strain
        else:
            beam = self.placement(z, np.zeros(self.space.size)).strain_rows @ self.rows(z) @ point.steady.coefficients
        return self._with_shapes(z, beam[..., None], point.steady.amplitudes[:, None])[..., 0]

    def about(self, point: OperatingPoint) -> Array:
        """Coefficients (N,) of the placement that vibration is about: that at rest where the steady state is linear."""
        if self.nonlinear and point.steady is not None:
            return point.steady.coefficients
        return np.zeros(self.space.size)

    def _with_shapes(self, z: Array, beam: Array, amplitudes: Array) -> Array:
        """(S, STRAINS, c) from beam strains (S, 6, c) and amplitudes (AMPLITUDES × terms, c)."""
        value, slope = self.shape_tables(z)
        by_shape = amplitudes.reshape(AMPLITUDES, self.space.terms, -1)
        shapes = [np.einsum("st,jtc->sjc", table, by_shape, optimize=True) for table in (value, slope)]
        return np.concatenate([beam, *shapes], axis=1)

    def cut_for(self, wall: str, width: float) -> SectionsAlong:
        """The sections with the wall's elements cut where a strip of some width in its middle begins and ends."""
        edges = self.sections.solid.ring.edges
        if any(edge.wall == wall and abs(edge.reach - 0.5 * width) <= 1e-9 * width for edge in edges):
            return self.sections
        return self.sections.cut_for(wall, width)

    @cached_property
    def _at(self) -> _AtStations:
        return _AtStations.of(self)

    @cached_property
    def matrices(self) -> BeamMatrices:
        """M, K_e, K_Ω and G₁ with the linear steady state's stresses, K_e alone at rest."""
        at = self._at
        placement = at.unloaded
        elastic = at.elastic(at.strain_rows)
        inertia = at.inertia(placement)
        push = at.force(inertia.centrifugal)
        coefficients = np.linalg.solve(elastic, push)
        resultants, _ = at.resultants(at.strain_rows @ coefficients)
        moments = np.einsum("sfi,si->sf", at.stress_moments, at.strain_rows @ coefficients)
        spin = at.form(placement.geometric(resultants) - inertia.centrifugal_softening)
        spin += at.strain_form(under_stress(moments), at.strain_rows)
        return BeamMatrices(
            mass=at.mass(inertia, at.strain_rows),
            elastic_stiffness=elastic,
            spin_stiffness=symmetric(spin),
            gyroscopic=at.form(inertia.gyroscopic),
        )

    @cached_property
    def linear_steady_state(self) -> SteadyState:
        """Per Ω²."""
        at = self._at
        coefficients = np.linalg.solve(self.matrices.elastic_stiffness, at.force(at.inertia(at.unloaded).centrifugal))
        return SteadyState(np.asarray(coefficients), at.resultants(at.strain_rows @ coefficients)[1])

    def at(self, speed: float, near: SteadyState | None = None) -> OperatingPoint:
        """The blade at a speed, rad/s; ``near`` is a steady state to start from. ``ValueError`` where there is no stable one."""
        if not self.nonlinear or speed == 0.0:
            linear, matrices = self.linear_steady_state, self.matrices
            steady = SteadyState(speed**2 * linear.coefficients, speed**2 * linear.amplitudes)
            return OperatingPoint(speed, matrices.mass, matrices.stiffness(speed), speed * matrices.gyroscopic, steady)
        return self._at.about(self._steady_state(speed, near), speed)

    def _steady_state(self, speed: float, near: SteadyState | None) -> Array:
        """Newton's method from a steady state nearby, or from the linear one."""
        at = self._at
        q = speed**2 * self.linear_steady_state.coefficients if near is None else near.coefficients
        for _ in range(ITERATIONS):
            step = at.newton_step(q, speed)
            if not np.all(np.isfinite(step)):
                break
            q = at.moved(q, step)
            if np.abs(at.rows[:, : SPIN.stop] @ step).max() <= CONVERGED:
                return q
        raise Refused("speed", speed, "a speed at which the blade has a steady state")


@dataclass(frozen=True, eq=False)
class _AtStations:
    """What does not depend on the speed, at the S stations."""

    beam: ExactBeam
    weight: Array
    frames: Array
    rows: Array
    energy: Array
    stress_moments: Array
    section_inertia: Array
    shape_mass: Array
    value: Array
    slope: Array
    arm: Array

    @classmethod
    def of(cls, beam: ExactBeam) -> _AtStations:
        z, sections = beam.stations.z, beam.sections
        solid = sections.solid
        value, slope = beam.shape_tables(z)
        energy = sections.at(z, without_shear(solid.energy) if beam.space.rigid else solid.energy)
        arm = np.zeros((len(z), 3))
        arm[:, 2] = beam.hub_radius + z
        return cls(
            beam=beam,
            weight=beam.stations.weight,
            frames=sections.planform.frames(z),
            rows=beam.rows(z),
            energy=energy,
            stress_moments=sections.at(z, solid.stress_moments),
            section_inertia=sections.at(z, solid.inertia),
            shape_mass=sections.at(z, solid.shape_mass),
            value=value,
            slope=slope,
            arm=arm,
        )

    @cached_property
    def unloaded(self) -> Placement:
        return Placement.of(np.zeros((len(self.weight), INCREMENT)), self.frames)

    @cached_property
    def strain_rows(self) -> Array:
        """(S, 6, N) of the unloaded blade."""
        return np.asarray(self.unloaded.strain_rows @ self.rows)

    @cached_property
    def shape_stiffness(self) -> tuple[Array, bool]:
        """K_aa, factorised."""
        terms = self.value.shape[1]
        whole = self._shape_form(self.energy[:, SHAPE, SHAPE], self.value, self.value)
        mixed = self._shape_form(self.energy[:, SHAPE, SHAPE_SLOPE], self.value, self.slope)
        whole = whole + mixed + mixed.T + self._shape_form(self.energy[:, SHAPE_SLOPE, SHAPE_SLOPE], self.slope, self.slope)
        size = AMPLITUDES * terms
        whole[np.arange(size), np.arange(size)] += HELD * np.diagonal(whole).max()
        return cho_factor(whole, lower=True, check_finite=False)

    def _shape_form(self, section: Array, left: Array, right: Array) -> Array:
        """∫ Φᵢ section_jk Φ′_l dz, (AMPLITUDES × terms)²."""
        terms = left.shape[1]
        products = (self.weight[:, None, None] * left[:, :, None] * right[:, None, :]).reshape(len(self.weight), -1)
        form = (section.reshape(len(section), -1).T @ products).reshape(AMPLITUDES, AMPLITUDES, terms, terms)
        return np.asarray(form.transpose(0, 2, 1, 3).reshape(AMPLITUDES * terms, -1))

    @cached_property
    def onto_shapes(self) -> Array:
        """L (S, 6, AMPLITUDES × terms): what a beam strain at a station asks of the shapes."""
        weighted = self.weight[:, None, None, None]
        onto = self.energy[:, BEAM, SHAPE, None] * self.value[:, None, None, :]
        onto = onto + self.energy[:, BEAM, SHAPE_SLOPE, None] * self.slope[:, None, None, :]
        return np.asarray((weighted * onto).reshape(len(self.weight), RIGID, -1))

    def amplitudes(self, strain: Array) -> Array:
        """(AMPLITUDES × terms, …) for strains (S, 6, …)."""
        asked = self.onto_shapes.reshape(-1, self.onto_shapes.shape[-1]).T @ strain.reshape(self.weight.size * RIGID, -1)
        return -cho_solve(self.shape_stiffness, asked, check_finite=False).reshape(-1, *strain.shape[2:])

    def resultants(self, strain: Array) -> tuple[Array, Array]:
        """Stress resultants (S, 6) in the sections' axes for strains (S, 6), and the amplitudes."""
        amplitudes = self.amplitudes(strain)
        own = (self.energy[:, BEAM, BEAM] @ strain[..., None])[..., 0]
        return own + self.onto_shapes @ amplitudes / self.weight[:, None], amplitudes

    def elastic(self, strain_rows: Array) -> Array:
        """∫ of the section's energy (N, N), with the shapes' amplitudes at their best."""
        beam = self.strain_form(self.energy[:, BEAM, BEAM], strain_rows)
        flat = strain_rows.reshape(-1, strain_rows.shape[-1])
        asked = self.onto_shapes.reshape(len(flat), -1).T @ flat
        return symmetric(beam - asked.T @ cho_solve(self.shape_stiffness, asked, check_finite=False))

    def strain_form(self, section: Array, strain_rows: Array) -> Array:
        """∫ rowsᵀ section rows dz (N, N) for sections (S, 6, 6)."""
        weighted = (self.weight[:, None, None] * section) @ strain_rows
        size = strain_rows.shape[-1]
        return np.asarray(strain_rows.reshape(-1, size).T @ weighted.reshape(-1, size))

    def form(self, of_increments: Array) -> Array:
        """∫ of a form (S, 12, 12) of increments, (N, N)."""
        weighted = (self.weight[:, None, None] * of_increments) @ self.rows
        size = self.rows.shape[-1]
        return np.asarray(self.rows.reshape(-1, size).T @ weighted.reshape(-1, size))

    def force(self, on_increments: Array) -> Array:
        """∫ of forces (S, 12), (N,)."""
        return np.asarray(self.rows.reshape(-1, self.rows.shape[-1]).T @ (self.weight[:, None] * on_increments).ravel())

    def inertia(self, placement: Placement) -> SpinningSections:
        return SpinningSections.of(placement, self.section_inertia, self.arm)

    def mass(self, inertia: SpinningSections, strain_rows: Array) -> Array:
        """M (N, N), with that of the shapes."""
        follow = self.amplitudes(strain_rows)
        shapes = self._shape_form(self.shape_mass, self.value, self.value)
        return symmetric(self.form(inertia.mass_form) + follow.T @ shapes @ follow)

    def newton_step(self, q: Array, speed: float) -> Array:
        """Increment (N,) of displacements and spins towards the steady state from coefficients q."""
        placement = Placement.of(self.rows @ q, self.frames)
        resultants, stiffness = self._stressed(placement)
        strain_rows = placement.strain_rows @ self.rows
        inertia = self.inertia(placement)
        pull = strain_rows.reshape(-1, strain_rows.shape[-1]).T @ (self.weight[:, None] * resultants).ravel()
        tangent = self._tangent(placement, resultants, stiffness, inertia, strain_rows, speed)
        return np.asarray(np.linalg.solve(tangent, speed**2 * self.force(inertia.centrifugal) - pull))

    def _stressed(self, placement: Placement) -> tuple[Array, Array]:
        """Resultants (S, 6) and what the fibres' quadratic extension adds to the section's stiffness (S, 6, 6)."""
        strain = placement.strain
        moments = np.einsum("sfi,si->sf", self.stress_moments, strain)
        fibres = FibreExtension.of(strain)
        resultants = self.resultants(strain)[0] + fibres.resultants(moments, self.stress_moments)
        return resultants, fibres.stiffness(moments, self.stress_moments)

    def _tangent(
        self, placement: Placement, resultants: Array, stiffness: Array, inertia: SpinningSections, strain_rows: Array, speed: float
    ) -> Array:
        whole = self.elastic(strain_rows) + self.strain_form(stiffness, strain_rows)
        return symmetric(whole + self.form(placement.geometric(resultants) - speed**2 * inertia.centrifugal_softening))

    def moved(self, q: Array, step: Array) -> Array:
        """Coefficients after an increment of displacements and spins: the rotations are put together and fitted again."""
        state, increment = self.rows @ q, self.rows @ step
        turned = rotation(increment[:, SPIN]) @ rotation(state[:, SPIN])
        beyond = rotation_vector(turned) - state[:, SPIN] - increment[:, SPIN]
        return q + step + self._fit(beyond)

    def _fit(self, beyond: Array) -> Array:
        """Coefficients (N,) of rotations (S, 3) by least squares."""
        spins = self.rows[:, SPIN]
        return np.asarray(self._spin_fit @ (self.weight[:, None] * beyond).ravel()) if spins.size else np.zeros(self.rows.shape[-1])

    @cached_property
    def _spin_fit(self) -> Array:
        spins = self.rows[:, SPIN]
        flat = spins.reshape(-1, spins.shape[-1])
        normal = flat.T @ (np.repeat(self.weight, 3)[:, None] * flat)
        own = np.flatnonzero(np.diagonal(normal))
        fit = np.zeros((spins.shape[-1], len(flat)))
        fit[own] = np.linalg.solve(normal[np.ix_(own, own)], flat[:, own].T)
        return fit

    def about(self, q: Array, speed: float) -> OperatingPoint:
        """M, K and G about the steady state with coefficients q."""
        placement = Placement.of(self.rows @ q, self.frames)
        resultants, stiffness = self._stressed(placement)
        strain_rows = placement.strain_rows @ self.rows
        inertia = self.inertia(placement)
        return OperatingPoint(
            speed=speed,
            mass=self.mass(inertia, strain_rows),
            stiffness=self._tangent(placement, resultants, stiffness, inertia, strain_rows, speed),
            gyroscopic=speed * self.form(inertia.gyroscopic),
            steady=SteadyState(q, self.amplitudes(placement.strain)),
        )


def without_shear(energy: Array) -> Array:
    """Energies (V, STRAINS, STRAINS) of sections that shear as they please, their shear strains held to cost nothing."""
    shears = slice(0, 2)
    free = energy - energy[:, :, shears] @ np.linalg.solve(energy[:, shears, shears], energy[:, shears, :])
    free[:, shears, :] = free[:, :, shears] = 0.0
    return free
