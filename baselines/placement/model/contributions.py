"""What a patch adds to a blade wherever it lies, from integrals along the span taken once.

Pretwist, taper and the walls' kinematics depend on z alone, so a patch from a to a + l adds I(a + l) − I(a) to a matrix, with
I(z) = ∫₀ᶻ of what a covered section has and a bare one has not. I is smooth: a Chebyshev series holds it to round-off. Sections
are bare, covered on top, below, or on both walls (the closed cell couples its walls, so "both" is not the sum). What follows is of
the thesis' model, to rounding; ``solid_contributions`` has the blade's.

The added mass m' also pulls: with T(z) = T₀(z) + ∫_z m'(R₀ + σ) dσ the centrifugal stiffening between two patch edges is
∫ T₀ S dz + c ∫ S dz − ∫ h S dz, where S = u'u' + v'v' + (I_p/m) φ'φ', h(z) = ∫₀ᶻ m'(R₀ + σ) dσ and c is constant there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.chebyshev import ChebyshevSpan
from baselines.placement.model.solid_contributions import BareBlade, Covering
from baselines.placement.model.triangles import packed
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.configuration import Refused
from beamenv.configuration.read_only import ReadOnly
from beamenv.patches import force_per_span
from beamenv.structure import RotatingBeam
from beamenv.structure.assembly import generalised_displacements, generalised_strains
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint
from beamenv.structure.modes import normal_modes
from beamenv.structure.walls.inlay import Strip

Array = NDArray[np.float64]

COVERED = ((), (0,), (1,), (0, 1))
"""What is covered in a section of kind 0 (bare), 1 (top), 2 (below), 3 (both)."""
BARE, TOP, BELOW, BOTH = range(len(COVERED))

KEPT = 60
"""Modes of a bare blade of solid sections that layouts are made of."""

EXTRA_COEFFICIENTS = 12
"""Beyond two for each trial function (products of two of them are integrated): pretwist and taper then leave round-off only."""


@dataclass(frozen=True, slots=True, eq=False)
class Contributions(ReadOnly):
    """A blade at one speed in the coordinates in which its bare stiffness is the identity, and what patches add to it.

    The coordinates are its N modes, each divided by its frequency: K = I + ΔK, M = diag(1/ω²) + ΔM.
    """

    span: ChebyshevSpan
    """0 … 0.7 L, where patches may lie; k coefficients."""
    bare_frequencies: Array
    """(N,), rad/s."""
    bare_gyroscopic: Array
    """G (N, N) of the bare blade."""
    line_load: Array
    """(N, 2): generalised force per N/m."""
    stiffness: Array
    """(7 k, T): upper triangles; 3 k of sections covered on top, below, on both, with bare T₀ and −h, then 4 k of Ω² ∫S for
    every kind of section, to be multiplied by c."""
    mass: Array
    """(3 k, T): upper triangles."""
    gyroscopic: Array
    """(3 k, T): upper triangles of skew matrices."""
    tension: Array
    """(k, 4): h(z) for each kind of section, kg m/m·m = N per (rad/s)²."""
    actuator_force: Array
    """(2, k, N): per volt, with nothing below, and what a sensor below changes."""
    sensor_force: Array
    """(2, k, N): the same of a sensor, driven as an actuator, with nothing above and what an actuator above changes."""
    actuator_energy: Array | None = None
    """(2, k): twice the energy, J/V², that an actuator stores in the blade at rest, and what a sensor below changes; None in the
    thesis' model, whose FᵀK⁻¹F is of the whole blade."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """Coordinates of a bare blade that its patches' contributions are expressed in."""

    frequencies: Array
    """(N,), rad/s."""
    basis: Array
    """(n, N): its modes by the trial functions, each divided by its frequency."""


def contributions(config: BladeConfig, frame: Frame | None = None) -> Contributions:
    """The contributions of a configuration's patches, for any position of them; takes some tenths of a second.

    Contributions of sheets of several sizes are in the same coordinates where they are given one ``frame``. A blade of finite
    elements, whose strains jump from one to the next, is taken by polynomials along the span. ``ValueError`` for one that heat
    strains or springs hold.
    """
    config = by_polynomials(config)
    return of_walls(config, frame) if config.model == "thesis" else of_solid_sections(config, frame)


def frame_of(config: BladeConfig) -> Frame:
    """The bare blade's own; ``ValueError`` as ``contributions`` raises it."""
    config = by_polynomials(config)
    bare = config.beam.build(model=config.model)
    if config.model == "thesis":
        frequencies, shapes = normal_modes(bare.matrices.mass, bare.matrices.stiffness(config.speed))
    else:
        frequencies, shapes = lowest_of(bare.at(config.speed), config.modes, bare.space.size)
    return Frame(frequencies, shapes / frequencies)


def by_polynomials(config: BladeConfig) -> BladeConfig:
    """The blade by polynomials along the span; ``ValueError`` for one that heat strains or springs hold."""
    _check_free(config.beam)
    if config.beam.discretisation == "galerkin":
        return config
    beam = replace(config.beam, discretisation="galerkin", elements=None, element_order=None, mesh=None)
    return replace(config, beam=beam)


def _check_free(beam: BeamConfig) -> None:
    if beam.temperatures is not None:
        hot = beam.temperatures[0][1]
        raise Refused("blade.beam.temperature", hot, "None where patches are placed, at the temperature of their data (K)")
    if beam.tip_springs is not None and any(beam.tip_springs):
        raise Refused("blade.beam.tip_springs", list(beam.tip_springs), "None where patches are placed on a cantilever")


def lowest_of(point: OperatingPoint, modes: int, size: int) -> tuple[Array, Array]:
    """As many modes, and their shapes, as layouts with ``modes`` modes are made of."""
    return normal_modes(point.mass, point.stiffness, min(max(KEPT, 2 * modes), size))


def of_solid_sections(config: BladeConfig, frame: Frame | None = None) -> Contributions:
    """In the blade's model."""
    (actuators, sensors), bare = config.patches.pair(), config.beam.build(model=config.model)
    span = ChebyshevSpan(actuators.outermost * bare.length, 2 * bare.space.order + EXTRA_COEFFICIENTS)
    covering = Covering.of(config, bare, span)
    exact = covering.bare(bare.exact)
    point = exact.at(config.speed)
    if frame is None:
        frequencies, shapes = lowest_of(point, config.modes, bare.space.size)
        frame = Frame(frequencies, shapes / frequencies)
    frequencies, basis = frame.frequencies, frame.basis
    blade = BareBlade.of(exact, point, span.nodes, basis)
    sections = [covering.samples(kind, blade) for kind in range(len(COVERED))]
    tension = span.integral(np.stack([s.pull - sections[BARE].pull for s in sections], axis=1))
    pull = span.values(span.nodes) @ tension
    slopes = [s.per_tension * config.speed**2 for s in sections]
    stiffness = [s.stiffness - pull[:, kind, None, None] * slopes[kind] for kind, s in enumerate(sections)]
    top, below = (span.integral(np.stack([s.forces[side] for s in sections], axis=1)) for side in range(2))
    energy = span.integral(np.stack([s.energy for s in sections], axis=1))
    return Contributions(
        span=span,
        bare_frequencies=frequencies,
        bare_gyroscopic=basis.T @ point.gyroscopic @ basis,
        line_load=basis.T @ bare.line_load(),
        stiffness=np.concatenate([beyond_bare(span, stiffness), stacked(span, slopes)]),
        mass=beyond_bare(span, [s.mass for s in sections]),
        gyroscopic=config.speed * beyond_bare(span, [s.gyroscopic for s in sections]),
        tension=tension,
        actuator_force=np.stack([top[:, TOP], top[:, BOTH] - top[:, TOP]]),
        sensor_force=sensors.patch.charge_per_reaction * np.stack([below[:, BELOW], below[:, BOTH] - below[:, BELOW]]),
        actuator_energy=np.stack([energy[:, TOP], energy[:, BOTH] - energy[:, TOP]]),
    )


def of_walls(config: BladeConfig, frame: Frame | None = None) -> Contributions:
    """In the thesis' model."""
    actuators, sensors = config.patches.pair()
    bare = config.beam.build(model=config.model)
    span = ChebyshevSpan(actuators.outermost * bare.length, 2 * bare.space.order + EXTRA_COEFFICIENTS)
    frame = frame_of(config) if frame is None else frame
    frequencies, basis = frame.frequencies, frame.basis
    sections = [SectionSamples.of(beam, span, basis) for beam in covered_blades(config, span)]
    tension = span.integral(np.stack([s.added_pull(sections[BARE]) for s in sections], axis=1))
    bare_tension, pull = tension_of(bare, span.nodes), span.values(span.nodes) @ tension
    slopes = [s.slope_squares * config.speed**2 for s in sections]
    stiffness = [
        s.elastic + config.speed**2 * s.softening + (bare_tension - pull[:, kind])[:, None, None] * slopes[kind]
        for kind, s in enumerate(sections)
    ]
    forces = [force_samples(beam, config, span, basis) for beam in covered_blades(config, span)]
    top, below = span.integral(np.stack([f[0] for f in forces], axis=1)), span.integral(np.stack([f[1] for f in forces], axis=1))
    return Contributions(
        span=span,
        bare_frequencies=frequencies,
        bare_gyroscopic=config.speed * basis.T @ bare.matrices.gyroscopic @ basis,
        line_load=basis.T @ bare.line_load(),
        stiffness=np.concatenate([beyond_bare(span, stiffness), stacked(span, slopes)]),
        mass=beyond_bare(span, [s.mass for s in sections]),
        gyroscopic=config.speed * beyond_bare(span, [s.gyroscopic for s in sections]),
        tension=tension,
        actuator_force=np.stack([top[:, TOP], top[:, BOTH] - top[:, TOP]]),
        sensor_force=sensors.patch.charge_per_reaction * np.stack([below[:, BELOW], below[:, BOTH] - below[:, BELOW]]),
    )


def covered_blades(config: BladeConfig, span: ChebyshevSpan) -> list[RotatingBeam]:
    """The blade bare, and with its walls covered over the whole span of patches; all bare where patches are not passive."""
    bare, groups = config.beam.build(model=config.model), config.patches.pair()
    if not groups[0].passive:
        return [bare] * len(COVERED)
    sheets = [group.inlay(0.0, span.end) for group in groups]
    return [replace(bare, inlays=tuple(sheets[side] for side in sides)) for sides in COVERED]


@dataclass(frozen=True, slots=True, eq=False)
class SectionSamples:
    """Integrands of the blade's matrices at the nodes, (nodes, N, N), of one kind of section."""

    elastic: Array
    mass: Array
    gyroscopic: Array
    softening: Array
    slope_squares: Array
    pull: Array
    """(nodes,): m (R₀ + z), kg."""

    @classmethod
    def of(cls, beam: RotatingBeam, span: ChebyshevSpan, basis: Array) -> SectionSamples:
        """Sample a blade whose sections are all of one kind over the span of patches."""
        walls = beam.walls_at(span.nodes)
        rows = {key: row @ basis for key, row in beam.space.evaluate(span.nodes).items()}
        strain, motion = generalised_strains(rows), generalised_displacements(rows)
        inertia = walls.inertia()
        half = quadratic(motion, 2.0 * inertia.lag_span)
        slopes = np.stack([rows["u", 1], rows["v", 1], rows["phi", 1]], axis=1)
        radius = (inertia.polar / inertia.mass_per_length)[:, None]
        share = np.concatenate([np.ones((len(radius), 2)), radius], axis=1)
        return cls(
            elastic=quadratic(strain, walls.stiffness()),
            mass=quadratic(motion, inertia.mass),
            gyroscopic=half - half.transpose(0, 2, 1),
            softening=quadratic(motion, inertia.spin_stiffness),
            slope_squares=slopes.transpose(0, 2, 1) @ (share[..., None] * slopes),
            pull=inertia.mass_per_length * (beam.hub_radius + span.nodes),
        )

    def added_pull(self, bare: SectionSamples) -> Array:
        """m'(R₀ + z) (nodes,), kg."""
        return self.pull - bare.pull


def quadratic(rows: Array, section: Array) -> Array:
    """rowsᵀ section rows (nodes, N, N) from (nodes, 9, N) and (nodes, 9, 9)."""
    return rows.transpose(0, 2, 1) @ (section @ rows)


def tension_of(bare: RotatingBeam, z: Array) -> Array:
    """T₀ (nodes,) = ∫_z^L m (R₀ + σ) dσ of the bare blade, N per (rad/s)²."""
    whole = ChebyshevSpan(bare.length, 2 * bare.space.order + EXTRA_COEFFICIENTS)
    mass = bare.walls_at(whole.nodes).inertia().mass_per_length
    pulled = whole.integral(mass * (bare.hub_radius + whole.nodes))
    return np.asarray((whole.values(np.array([bare.length])) - whole.values(z)) @ pulled)


def force_samples(beam: RotatingBeam, config: BladeConfig, span: ChebyshevSpan, basis: Array) -> tuple[Array, Array]:
    """Force per volt and metre (nodes, N) of a patch on the actuators' and on the sensors' wall."""
    on_top, below = (
        force_per_span(beam, group.patch, Strip(group.wall, group.width), span.nodes) for group in config.patches.pair()
    )
    return on_top @ basis, below @ basis


def stacked(span: ChebyshevSpan, samples: list[Array]) -> Array:
    """Integrals of several samples (nodes, N, N), as triangles under each other: (len · k, T)."""
    return np.concatenate([packed(span.integral(sample)) for sample in samples])


def beyond_bare(span: ChebyshevSpan, samples: list[Array]) -> Array:
    """What the covered kinds of section have and the bare one has not: (3 k, T)."""
    return stacked(span, [sample - samples[BARE] for sample in samples[1:]])
