"""The blade's model: M, K and G at a speed, about the steady state there, and what its sections are strained by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.configuration.read_only import sealed_property
from beamenv.structure.assembly import BeamMatrices, definite, symmetric
from beamenv.structure.geometrically_exact.at_stations import BladeAtStations
from beamenv.structure.geometrically_exact.heat import Heat
from beamenv.structure.geometrically_exact.kinematics import SPIN, Placement, under_stress
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint, SteadyState
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.geometrically_exact.tables import increment_rows
from beamenv.structure.geometrically_exact.tip_springs import TipSprings
from beamenv.structure.section.amplitudes import AMPLITUDES
from beamenv.structure.section.elements import RIGID
from beamenv.structure.span_space import SpanSpace
from beamenv.structure.stations import Stations
from beamenv.structure.walls.inlay import Strip

Array = NDArray[np.float64]

ITERATIONS = 30
"""Most Newton steps to the steady state; five or six do."""

FREE = 2
"""Newton steps that may grow; where later ones do, no steady state is near."""

FREE_UNDER_HEAT = 8
"""The same of a heated blade, of which bending stretches the linear steady state at first."""

HALVINGS = 5
"""Most halvings of a step in Ω² towards a steady state that Newton's method does not find from the linear one."""

CONVERGED = 1e-4
"""Largest increment, m or rad, after which no further step is made: steps shrink as their squares, so the next were of 1e-9."""


CONVERGED_UNDER_HEAT = 1e-6
"""The same of a heated blade: 1e-7 m, over the span, are some per mille of what buckles a slender one that is held."""


@dataclass(frozen=True, eq=False)
class ExactBeam:
    """A blade, its sections along the span, and the stations at which it is integrated."""

    space: SpanSpace
    stations: Stations
    sections: SectionsAlong
    hub_radius: float
    nonlinear: bool
    """Whether vibration is about the non-linear steady state, or about the blade at rest under the stresses of a linear one."""
    heat: Heat | None = None
    springs: TipSprings | None = None
    """What strains it and holds its tip beside the rotation."""

    @property
    def loaded_at_rest(self) -> bool:
        """Whether anything strains it or holds its tip when it does not turn."""
        return self.heat is not None or self.springs is not None

    def placement(self, z: Array, coefficients: Array) -> Placement:
        """Where the blade is at stations z."""
        return Placement.of(increment_rows(self.space, z) @ coefficients, self.sections.planform.frames(z))

    def section_strains(self, z: Array, point: OperatingPoint) -> Array:
        """(S, STRAINS, N): strains of the sections at stations z (m) per coefficient, of vibration about the steady state."""
        assert point.following is not None
        rows = increment_rows(self.space, z)
        placement = Placement.of(rows @ self.about(point), self.sections.planform.frames(z))
        return self._with_shapes(z, placement.strain_rows @ rows, point.following)

    def generalised_force(self, z: Array, point: OperatingPoint, work: Array) -> Array:
        """(N, k): force of k actions that do ``work`` (S, STRAINS, k) per strain of the sections at stations z (m)."""
        assert point.following is not None
        rows = increment_rows(self.space, z)
        placement = Placement.of(rows @ self.about(point), self.sections.planform.frames(z))
        on_increments = placement.strain_rows.swapaxes(-1, -2) @ work[:, :RIGID]
        actions = work.shape[-1]
        force = rows.reshape(-1, self.space.size).T @ on_increments.reshape(-1, actions)
        for table, part in zip(self.space.amplitude_table(z), np.split(work[:, RIGID:], 2, axis=1), strict=True):
            on_shapes = (table.T @ part.reshape(len(z), -1)).reshape(self.space.amplitude_terms, AMPLITUDES, actions)
            force += point.following.T @ on_shapes.swapaxes(0, 1).reshape(-1, actions)
        return np.asarray(force)

    def steady_strains(self, z: Array, point: OperatingPoint) -> Array:
        """(S, STRAINS): strains of the sections at stations z (m) in the steady state."""
        assert point.steady is not None
        if self.about(point).any():
            beam = self.placement(z, point.steady.coefficients).strain
        else:
            beam = (
                self.placement(z, np.zeros(self.space.size)).strain_rows @ increment_rows(self.space, z) @ point.steady.coefficients
            )
        return self._with_shapes(z, beam[..., None], point.steady.amplitudes[:, None])[..., 0]

    def base_forces(self, point: OperatingPoint) -> tuple[Array, Array]:
        """Centrifugal force per Ω² and Euler's per Ω̇, (N,) each, where the blade stands that vibration is about."""
        at = self.at_stations
        inertia = at.inertia(Placement.of(at.rows @ self.about(point), at.frames))
        return at.force(inertia.centrifugal), at.force(inertia.euler)

    def steady_state_slope(self, point: OperatingPoint) -> Array:
        """W (N,): by how much the steady state moves and turns per Ω²."""
        if not self.nonlinear:
            return self.linear_steady_state.coefficients
        return np.asarray(np.linalg.solve(point.stiffness, self.base_forces(point)[0]))

    def about(self, point: OperatingPoint) -> Array:
        """Coefficients (N,) of the placement that vibration is about: that at rest where the steady state is linear."""
        if self.nonlinear and point.steady is not None:
            return point.steady.coefficients
        return np.zeros(self.space.size)

    def _with_shapes(self, z: Array, beam: Array, amplitudes: Array) -> Array:
        """(S, STRAINS, c) from beam strains (S, 6, c) and amplitudes (AMPLITUDES × terms, c)."""
        value, slope = self.space.amplitude_table(z)
        by_shape = amplitudes.reshape(AMPLITUDES, self.space.amplitude_terms, -1)
        shapes = [np.einsum("st,jtc->sjc", table, by_shape, optimize=True) for table in (value, slope)]
        return np.concatenate([beam, *shapes], axis=1)

    def cut_for(self, strip: Strip) -> SectionsAlong:
        """The sections with a wall's elements cut where a strip begins and ends."""
        if any(strip in edge.strips for edge in self.sections.solid.mesh.edges):
            return self.sections
        return self.sections.cut_for(strip)

    @sealed_property
    def at_stations(self) -> BladeAtStations:
        """The blade where it is integrated."""
        return BladeAtStations.of(self.space, self.stations, self.sections, self.hub_radius, self.heat, self.springs)

    @sealed_property
    def matrices(self) -> BeamMatrices:
        """M, K_e, K_Ω and G₁ with the linear steady state's stresses; at rest K_e, with those of heat where that is linear too."""
        at = self.at_stations
        placement = at.unloaded
        elastic = at.elastic_at_rest
        inertia = at.inertia(placement)
        coefficients = np.linalg.solve(elastic, at.force(inertia.centrifugal))
        strain = at.strain_rows @ coefficients
        asked = at.asked(strain)
        resultants, moments = at.resultants(strain, asked), at.moments(strain, asked)
        stressed = placement.strain_rows.swapaxes(-1, -2) @ under_stress(moments) @ placement.strain_rows
        spin = at.form(placement.geometric(resultants) - inertia.centrifugal_softening + stressed)
        return BeamMatrices(
            mass=at.mass(inertia, at.following_at_rest),
            elastic_stiffness=elastic if self.nonlinear else self._with_thermal_stress(elastic),
            spin_stiffness=symmetric(spin),
            gyroscopic=at.form(inertia.gyroscopic),
        )

    def _with_thermal_stress(self, elastic: Array) -> Array:
        if self.heat is None:
            return elastic
        stiffness = elastic + self.at_stations.stress_stiffness(self.heated_at_rest.coefficients)
        self._check_stable(stiffness)
        return stiffness

    def _check_stable(self, stiffness: Array) -> None:
        """``ValueError`` where a heated blade buckles."""
        if self.heat is not None and not definite(stiffness):
            raise self.heat.buckles(self.sections.planform)

    @sealed_property
    def linear_steady_state(self) -> SteadyState:
        """Per Ω², beside what heat does."""
        at = self.at_stations
        coefficients = np.linalg.solve(at.elastic_at_rest, at.force(at.inertia(at.unloaded).centrifugal))
        return SteadyState(np.asarray(coefficients), at.amplitudes(at.asked(at.strain_rows @ coefficients)))

    @sealed_property
    def heated_at_rest(self) -> SteadyState:
        """The linear steady state of a blade that is heated and does not turn."""
        at = self.at_stations
        coefficients = np.asarray(np.linalg.solve(at.elastic_at_rest, at.thermal_force))
        strain = at.strain_rows @ coefficients
        return SteadyState(coefficients, at.amplitudes(at.stressing(strain, at.asked(strain))[1]))

    def _linear(self, speed: float, share: float = 1.0) -> SteadyState:
        """The linear steady state at a speed, under a share of the heat."""
        spun = self.linear_steady_state
        steady = SteadyState(speed**2 * spun.coefficients, speed**2 * spun.amplitudes)
        if self.heat is None:
            return steady
        heated = self.heated_at_rest
        return SteadyState(steady.coefficients + share * heated.coefficients, steady.amplitudes + share * heated.amplitudes)

    def at(self, speed: float, near: SteadyState | None = None) -> OperatingPoint:
        """The blade at a speed, rad/s; ``near`` is a steady state to start from. ``ValueError`` where there is no stable one."""
        if not self.nonlinear or (speed == 0.0 and self.heat is None):
            matrices, stiffness = self.matrices, self.matrices.stiffness(speed)
            self._check_stable(stiffness)
            return OperatingPoint(
                speed,
                matrices.mass,
                stiffness,
                speed * matrices.gyroscopic,
                self._linear(speed),
                self.at_stations.following_at_rest,
            )
        point = self.at_stations.about(self._steady_state(speed, near), speed)
        self._check_stable(point.stiffness)
        return point

    def _steady_state(self, speed: float, near: SteadyState | None) -> Array:
        """Newton's method from a steady state nearby, or from the linear one, by way of those at lower speeds where it must be."""
        found = None if near is None else self._newton(near.coefficients, Load(speed))
        if found is None:
            found = self._by_steps(None, Load(0.0, 0.0), Load(speed), HALVINGS)
        if found is None and self.heat is not None:
            raise self.heat.buckles(self.sections.planform)
        if found is None:
            raise Refused("speed", speed, "a speed at which the blade has a steady state")
        return found

    def _by_steps(self, state: Array | None, low: Load, high: Load, halvings: int) -> Array | None:
        """From the steady state under one load (None: none) to that under a higher one, halving the step where Newton fails."""
        found = self._newton(self._linear(high.speed, high.heat).coefficients if state is None else state, high)
        if found is not None or halvings == 0:
            return found
        middle = Load(float(np.sqrt(0.5 * (low.speed**2 + high.speed**2))), 0.5 * (low.heat + high.heat))
        between = self._by_steps(state, low, middle, halvings - 1)
        return None if between is None else self._by_steps(between, middle, high, halvings - 1)

    def _newton(self, q: Array, load: Load) -> Array | None:
        """Coefficients of the steady state, or None where it is not found."""
        at, before = self.at_stations, np.inf
        free, enough = (FREE, CONVERGED) if self.heat is None else (FREE_UNDER_HEAT, CONVERGED_UNDER_HEAT)
        for count in range(ITERATIONS):
            step = at.newton_step(q, load.speed, load.heat)
            largest = np.abs(at.rows[:, : SPIN.stop] @ step).max()
            if not np.isfinite(largest) or (count >= free and largest > before):
                return None
            q, before = at.moved(q, step), largest
            if largest <= enough:
                return q
        return None


class Load(NamedTuple):
    """What a steady state bears."""

    speed: float
    """rad/s."""
    heat: float = 1.0
    """Share of it."""
