"""A blade at the stations at which it is integrated, with the sections' warping eliminated.

The coefficients q are those of the reference line and the sections' turns, (u, v, s, θx, θy, φ). A section's shapes have
amplitudes a(z) of their own, zero at the clamp, which have next to no inertia: for given strains e(z) of the beam they take the
values of least energy, a = −K_aa⁻¹ ∫(Φᵀ E_ae + Φ′ᵀ E_a′e) e dz, and move with q (Guyan's reduction, whose mass they keep).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from beamenv.configuration.read_only import Sealed, sealed_property
from beamenv.structure.assembly import symmetric
from beamenv.structure.geometrically_exact.heat import FreeStrains, Heat
from beamenv.structure.geometrically_exact.inertia import SpinningSections
from beamenv.structure.geometrically_exact.kinematics import INCREMENT, SPIN, FibreExtension, Placement, under_stress
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint, SteadyState
from beamenv.structure.geometrically_exact.rigid_theory import moments_without_shear, without_shear
from beamenv.structure.geometrically_exact.rotations import rotation, rotation_vector
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.geometrically_exact.tables import FIELD_COUNT, field_tables, increment_rows
from beamenv.structure.geometrically_exact.tip_springs import TipSprings
from beamenv.structure.section.amplitudes import AMPLITUDES, STRAINS
from beamenv.structure.section.elements import RIGID
from beamenv.structure.section.integrals import MONOMIALS
from beamenv.structure.span_space import SpanSpace
from beamenv.structure.stations import Stations

Array = NDArray[np.float64]

BEAM, SHAPE, SHAPE_SLOPE = slice(0, RIGID), slice(RIGID, RIGID + AMPLITUDES), slice(RIGID + AMPLITUDES, STRAINS)


@dataclass(frozen=True, eq=False)
class BladeAtStations(Sealed):
    """A blade at the S stations at which it is integrated: what does not depend on the speed, and forms for any placement."""

    weight: Array
    """(S,), m."""
    arm: Array
    """(S, 3), m: from the hub's centre to the pitch axis, before anything is loaded."""
    frames: Array
    """C₀ (S, 3, 3)."""
    rows: Array
    """(S, 12, N): [u, c, u′, c′] per coefficient."""
    tables: Array | None
    """(S, 2, terms): values and slopes that all fields have in ``rows``; None where rotations are no fields of their own."""
    value: Array
    slope: Array
    """(S, terms): trial functions of the shapes' amplitudes, and their derivatives."""
    energy: Array
    """(S, STRAINS, STRAINS): of the sections, see ``SolidSections``."""
    stress_moments: Array
    """(S, 6, STRAINS): of the spanwise stress, see ``SolidSections``."""
    section_inertia: Array
    """(S, 6)"""
    shape_mass: Array
    """(S, AMPLITUDES, AMPLITUDES)"""
    held: float
    """Share of the stiffest shape's energy that every shape is given, so that one that does not warp has an amplitude too."""
    free: FreeStrains | None = None
    """Of a blade that is heated."""
    springs: TipSprings | None = None
    """Of one that is held at its tip."""

    @classmethod
    def of(
        cls,
        space: SpanSpace,
        stations: Stations,
        sections: SectionsAlong,
        hub_radius: float,
        heat: Heat | None = None,
        springs: TipSprings | None = None,
    ) -> BladeAtStations:
        """Gather the sections and tabulate the trial functions."""
        z, solid = stations.z, sections.solid
        value, slope = space.amplitude_table(z)
        energy, stress_moments = solid.energy, solid.stress_moments
        if space.rigid:
            energy, stress_moments = without_shear(energy), moments_without_shear(stress_moments, energy)
        return cls(
            weight=stations.weight,
            arm=np.column_stack([np.zeros_like(z), np.zeros_like(z), hub_radius + z]),
            frames=sections.planform.frames(z),
            rows=increment_rows(space, z),
            tables=None if space.rigid else np.stack(field_tables(space, z), axis=1),
            value=value,
            slope=slope,
            energy=sections.at(z, energy),
            stress_moments=sections.at(z, stress_moments),
            section_inertia=sections.at(z, solid.inertia),
            shape_mass=sections.at(z, solid.shape_mass),
            held=space.held,
            free=None if heat is None else FreeStrains.of(z, sections, heat),
            springs=springs,
        )

    @sealed_property
    def unloaded(self) -> Placement:
        """Where the blade is before anything is loaded."""
        return Placement.of(np.zeros((len(self.weight), INCREMENT)), self.frames)

    @sealed_property
    def strain_rows(self) -> Array:
        """(S, 6, N) of the unloaded blade."""
        return np.asarray(self.unloaded.strain_rows @ self.rows)

    @sealed_property
    def elastic_at_rest(self) -> Array:
        """∫ of the sections' energy (N, N) of the unloaded blade, with the shapes' amplitudes at their best, and the springs'."""
        rows = self.unloaded.strain_rows
        whole = self.form(rows.swapaxes(-1, -2) @ self.energy[:, BEAM, BEAM] @ rows)
        return symmetric(self._with_springs(whole - self._asked_at_rest.T @ self._asked_at_rest, np.zeros(len(whole))))

    def _with_springs(self, stiffness: Array, q: Array) -> Array:
        return stiffness if self.springs is None else stiffness + self.springs.tangent(q)

    @sealed_property
    def following_at_rest(self) -> Array:
        """(AMPLITUDES × terms, N): amplitudes per coefficient, of the unloaded blade."""
        return self.amplitudes(self._asked_at_rest)

    @sealed_property
    def _asked_at_rest(self) -> Array:
        return self.asked(self.strain_rows)

    @sealed_property
    def shape_stiffness(self) -> Array:
        """L with L Lᵀ = K_aa, lower triangular."""
        terms = self.value.shape[1]
        whole = self._shape_form(self.energy[:, SHAPE, SHAPE], self.value, self.value)
        mixed = self._shape_form(self.energy[:, SHAPE, SHAPE_SLOPE], self.value, self.slope)
        whole = whole + mixed + mixed.T + self._shape_form(self.energy[:, SHAPE_SLOPE, SHAPE_SLOPE], self.slope, self.slope)
        size = AMPLITUDES * terms
        whole[np.arange(size), np.arange(size)] += self.held * np.diagonal(whole).max()
        return np.asarray(np.linalg.cholesky(whole))

    def _shape_form(self, section: Array, left: Array, right: Array) -> Array:
        """∫ Φᵢ section_jk Φ′_l dz, (AMPLITUDES × terms)²."""
        terms = left.shape[1]
        products = (self.weight[:, None, None] * left[:, :, None] * right[:, None, :]).reshape(len(self.weight), -1)
        form = (section.reshape(len(section), -1).T @ products).reshape(AMPLITUDES, AMPLITUDES, terms, terms)
        return np.asarray(form.transpose(0, 2, 1, 3).reshape(AMPLITUDES * terms, -1))

    @sealed_property
    def onto_shapes(self) -> Array:
        """Z (AMPLITUDES × terms, 6S) = L⁻¹ ∫: what beam strains at the stations ask of the shapes, where their stiffness is 1."""
        weighted = self.weight[:, None, None, None]
        onto = self.energy[:, BEAM, SHAPE, None] * self.value[:, None, None, :]
        onto = onto + self.energy[:, BEAM, SHAPE_SLOPE, None] * self.slope[:, None, None, :]
        asked = (weighted * onto).reshape(RIGID * len(self.weight), -1).T
        return np.asarray(solve_triangular(self.shape_stiffness, asked, lower=True, check_finite=False))

    def asked(self, strain: Array) -> Array:
        """(AMPLITUDES × terms, …): Z e for strains e (S, 6, …); its square is the energy that the shapes save."""
        return np.asarray(self.onto_shapes @ strain.reshape(len(self.weight) * RIGID, *strain.shape[2:]))

    @sealed_property
    def _asked_by_heat(self) -> Array:
        """Z e_T − g: what is taken off what strains ask of the shapes."""
        assert self.free is not None
        onward = np.einsum("s,st,sj->jt", self.weight, self.slope, self.free.onward).ravel()
        return self.asked(self.free.strain) - solve_triangular(self.shape_stiffness, onward, lower=True, check_finite=False)

    def stressing(self, strain: Array, asked: Array, share: float = 1.0) -> tuple[Array, Array]:
        """Of strains (S, 6), which ask Z e of the shapes, those that make stress, beyond a share of what heat does, and theirs."""
        if self.free is None:
            return strain, asked
        return strain - share * self.free.strain, asked - share * self._asked_by_heat

    @sealed_property
    def thermal_force(self) -> Array:
        """(N,): what heat pushes the unloaded blade with."""
        assert self.free is not None
        resultants = self.resultants(self.free.strain, self._asked_by_heat)
        return self.force(np.einsum("sfi,sf->si", self.unloaded.strain_rows, resultants))

    def stress_stiffness(self, coefficients: Array, share: float = 1.0) -> Array:
        """(N, N): what the stresses of small displacements and of heat add to the stiffness of the unloaded blade."""
        placement, strain = self.unloaded, self.strain_rows @ coefficients
        strain, asked = self.stressing(strain, self.asked(strain), share)
        stressed = (
            placement.strain_rows.swapaxes(-1, -2) @ under_stress(self._moments(strain, asked, share)) @ placement.strain_rows
        )
        return symmetric(self.form(placement.geometric(self.resultants(strain, asked)) + stressed))

    def _moments(self, strain: Array, asked: Array, share: float) -> Array:
        """With those that balance."""
        moments = self.moments(strain, asked)
        return moments if self.free is None else moments + share * self.free.moments

    def amplitudes(self, asked: Array) -> Array:
        """(AMPLITUDES × terms, …): those of least energy, −L⁻ᵀ Z e."""
        return np.asarray(-solve_triangular(self.shape_stiffness, asked, lower=True, trans=1, check_finite=False))

    def resultants(self, strain: Array, asked: Array) -> Array:
        """Stress resultants (S, 6) in the sections' axes for strains (S, 6)."""
        own = (self.energy[:, BEAM, BEAM] @ strain[..., None])[..., 0]
        return np.asarray(own - (asked @ self.onto_shapes).reshape(own.shape) / self.weight[:, None])

    def moments(self, strain: Array, asked: Array) -> Array:
        """∫σ_zz (1, x, y, x², xy, y²) dA (S, 6) for strains (S, 6)."""
        own = (self.stress_moments[:, :, BEAM] @ strain[..., None])[..., 0]
        return np.asarray(own + (self._moments_of_asked @ asked).reshape(own.shape))

    @sealed_property
    def _moments_of_asked(self) -> Array:
        """X (6S, AMPLITUDES × terms): what Z e adds to the moments, the amplitudes being −L⁻ᵀ Z e."""
        of_shapes = self.stress_moments[:, :, SHAPE, None] * self.value[:, None, None, :]
        of_shapes = of_shapes + self.stress_moments[:, :, SHAPE_SLOPE, None] * self.slope[:, None, None, :]
        flat = of_shapes.reshape(len(self.weight) * MONOMIALS, -1).T
        return np.asarray(-solve_triangular(self.shape_stiffness, flat, lower=True, check_finite=False).T)

    def _drawn(self, squares: Array) -> Array:
        """Xᵀ ∫ (AMPLITUDES × terms, …): what the fibres' quadratic extension (S, 6, …) asks of the shapes."""
        weight = self.weight.reshape(-1, *[1] * (squares.ndim - 1))
        return np.asarray(self._moments_of_asked.T @ (weight * squares).reshape(len(self.weight) * MONOMIALS, *squares.shape[2:]))

    def form(self, of_increments: Array) -> Array:
        """∫ of a form (S, 12, 12) of increments, (N, N)."""
        weighted = self.weight[:, None, None] * of_increments
        if self.tables is None:
            size = self.rows.shape[-1]
            return np.asarray(self.rows.reshape(-1, size).T @ (weighted @ self.rows).reshape(-1, size))
        stations, orders, terms = self.tables.shape
        blocks = weighted.reshape(stations, orders, FIELD_COUNT, orders, FIELD_COUNT, 1)
        across = self.tables[:, None, None, None]
        right = blocks[:, :, :, 0] * across[..., 0, :] + blocks[:, :, :, 1] * across[..., 1, :]
        both = self.tables.reshape(-1, terms).T @ right.reshape(stations * orders, -1)
        size = FIELD_COUNT * terms
        return np.asarray(both.reshape(terms, FIELD_COUNT, -1).swapaxes(0, 1).reshape(size, size))

    def force(self, on_increments: Array) -> Array:
        """∫ of forces (S, 12), (N,)."""
        return np.asarray(self.rows.reshape(-1, self.rows.shape[-1]).T @ (self.weight[:, None] * on_increments).ravel())

    def inertia(self, placement: Placement) -> SpinningSections:
        """The sections' inertia where the blade is."""
        return SpinningSections.of(placement, self.section_inertia, self.arm)

    def mass(self, inertia: SpinningSections, following: Array) -> Array:
        """M (N, N), with that of the shapes, whose amplitudes follow (AMPLITUDES × terms, N)."""
        return symmetric(self.form(inertia.mass_form) + following.T @ self._shapes_mass @ following)

    @sealed_property
    def _shapes_mass(self) -> Array:
        return self._shape_form(self.shape_mass, self.value, self.value)

    def newton_step(self, q: Array, speed: float, share: float = 1.0) -> Array:
        """Increment (N,) of displacements and spins towards the steady state, under a share of the heat, from coefficients q."""
        placement = Placement.of(self.rows @ q, self.frames)
        inertia, stressed = self.inertia(placement), self._stressed(placement, self.asked(placement.strain), share)
        pull = np.einsum("sfi,sf->si", placement.strain_rows, stressed.resultants)
        push = self.force(speed**2 * inertia.centrifugal - pull)
        if self.springs is not None:
            push = push - self.springs.force(q)
        rows = placement.strain_rows @ self.rows
        tangent = self._with_springs(self._tangent(placement, stressed, inertia, speed, rows, self.asked(rows)), q)
        return np.asarray(np.linalg.solve(tangent, push))

    def _stressed(self, placement: Placement, asked: Array, share: float = 1.0) -> Stressed:
        """The energy is ½ dᵀ E d − ½ |Z d + g|² + ½ ∫ m·s dz, with the strains d = e − e_T, the moments m of theirs and of heat,
        and the fibres' squares s of the strains e less those of e_T: a blade that expands freely is not stressed.
        """
        (strain, asked), per_strain = self.stressing(placement.strain, asked, share), self.stress_moments[:, :, BEAM]
        moments, fibres = self._moments(strain, asked, share), FibreExtension.of(placement.strain)
        if self.free is not None:
            fibres = fibres.beyond(share * self.free.strain)
        resultants = self.resultants(strain, asked - 0.5 * self._drawn(fibres.squares)) + fibres.resultants(moments, per_strain)
        return Stressed(resultants, self.energy[:, BEAM, BEAM] + fibres.stiffness(moments, per_strain), fibres)

    def _tangent(
        self, placement: Placement, stressed: Stressed, inertia: SpinningSections, speed: float, strain_rows: Array, asked: Array
    ) -> Array:
        """(N, N); ``asked`` is that of the strains per coefficient, ``strain_rows`` (S, 6, N)."""
        rows = placement.strain_rows
        local = rows.swapaxes(-1, -2) @ stressed.stiffness @ rows + placement.geometric(stressed.resultants)
        shapes = asked.T @ (asked - self._drawn(stressed.fibres.slopes @ strain_rows))
        return symmetric(self.form(local - speed**2 * inertia.centrifugal_softening) - shapes)

    def moved(self, q: Array, step: Array) -> Array:
        """Coefficients after an increment of displacements and spins: the rotations are put together and fitted again."""
        state, increment = self.rows @ q, self.rows @ step
        turned = rotation(increment[:, SPIN]) @ rotation(state[:, SPIN])
        beyond = rotation_vector(turned) - state[:, SPIN] - increment[:, SPIN]
        return np.asarray(q + step + self._spin_fit @ (self.weight[:, None] * beyond).ravel())

    @sealed_property
    def _spin_fit(self) -> Array:
        """(N, 3S): coefficients of rotations at the stations, weighted, by least squares."""
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
        strain_rows = placement.strain_rows @ self.rows
        steadily, asked = self.asked(placement.strain), self.asked(strain_rows)
        inertia, following = self.inertia(placement), self.amplitudes(asked)
        stiffness = self._tangent(placement, self._stressed(placement, steadily), inertia, speed, strain_rows, asked)
        return OperatingPoint(
            speed=speed,
            mass=self.mass(inertia, following),
            stiffness=self._with_springs(stiffness, q),
            gyroscopic=speed * self.form(inertia.gyroscopic),
            steady=SteadyState(q, self.amplitudes(self.stressing(placement.strain, steadily)[1])),
            following=following,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Stressed:
    """Sections under the strains of a placement."""

    resultants: Array
    """(S, 6), in the sections' axes."""
    stiffness: Array
    """(S, 6, 6), with what the fibres' quadratic extension adds."""
    fibres: FibreExtension
