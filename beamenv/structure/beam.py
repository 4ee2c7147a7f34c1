"""The rotating blade: section, lay-up and planform in, matrices, frequencies and mode shapes out."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import InstanceOf

from beamenv.configuration import Count, Flag, Number, Positive, Refused, checked, configuration
from beamenv.configuration.arrays import real_numbers
from beamenv.configuration.instead import InsteadOf
from beamenv.configuration.numbers import DEGREES
from beamenv.structure.assembly import BeamMatrices, assemble, generalised_strains
from beamenv.structure.breaks import breakpoints, breaks
from beamenv.structure.discretisation import DISCRETISATION, ELEMENT_ORDER, ELEMENTS, MESH, check_discretisation, element_space
from beamenv.structure.geometrically_exact.exact_beam import ExactBeam
from beamenv.structure.geometrically_exact.heat import Heat
from beamenv.structure.geometrically_exact.operating_point import OperatingPoint
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.geometrically_exact.tip_springs import TipSprings
from beamenv.structure.held_and_heated import (
    BLADE_KELVIN,
    DIFFERENCE,
    SPRINGS,
    check_data,
    check_held_and_heated,
    temperatures_of,
)
from beamenv.structure.inlays import SHORTEST, Room
from beamenv.structure.model import FLOW, MODEL, STEADY_STATE, check_steady_state, checked_flow, terms_of
from beamenv.structure.modes import Modes, critical_speed, energy_participation, normal_modes, whirling_frequencies, whirling_modes
from beamenv.structure.planform import TABLE, Planform, Steps, check_table
from beamenv.structure.scale import OUT_OF_SCALE, in_scale
from beamenv.structure.section.section import THEORY, Metres, Section
from beamenv.structure.section.span_walls import SpanWalls
from beamenv.structure.span_space import MOTIONS, SpanSpace
from beamenv.structure.trial_functions import TrialSpace
from beamenv.structure.walls.curves import ROOM
from beamenv.structure.walls.inlay import Inlay, Strip
from beamenv.structure.walls.laminate import Layup

Array = NDArray[np.float64]

EXTRA_STATIONS = 6
"""Gauss stations beyond the number of terms on each piece of the span: pretwist and taper are then integrated to round-off."""

CLAMP_REACH = 0.05
"""Of a section's perimeter: distance over which warping that the clamp holds back grows by 1 − 1/e. Any value is an upper bound of
the energy; here it is near the least for boxes, isotropic and of 30° plies."""

CLAMP_PIECE = 5.0
"""Piece of the span beside the clamp that has stations of its own, in reaches."""

TERMS = Count(1, 30)
SPEED = Number(ge=0.0, unit="rad/s")


@configuration("beam", slots=False, eq=False)
class RotatingBeam:
    """A rotating, pretwisted, tapered, thin-walled composite cantilever (thesis chapters 2 and 3, corrected).

    z runs along the span from the clamped root, x lies in the plane of rotation (lag), y along the spin axis (flap).

    Raises ``ValueError`` for a length, taper or number of terms that is not positive, a negative hub radius, an unknown
    theory, a shear flow or steady state that its model has not, a lay-up of other walls than the section's, walls that fill
    the tip, or inlays that leave the blade, overlap or do not fit their wall.
    """

    section: InstanceOf[Section]
    """Mid-line section at the root."""
    layup: InstanceOf[Layup]
    length: Metres
    """m."""
    hub_radius: Annotated[float, Number(ge=0.0, unit="m")] = 0.0
    """R₀, m."""
    pretwist_deg: Annotated[float, DEGREES] = 0.0
    """Linear pretwist between root and tip."""
    presetting_deg: Annotated[float, DEGREES] = 0.0
    """Angle of the root section's chord from the plane of rotation."""
    taper: Positive = 1.0
    """Root chord over tip chord, and root depth over tip depth (Eq. 2.39)."""
    twist_table: Annotated[Steps | None, TABLE, InsteadOf("pretwist_deg", 0.0)] = None
    """Pretwist along the span in place of an even one: pairs of the share of the span, from 0 to 1, and degrees."""
    chord_table: Annotated[Steps | None, TABLE, InsteadOf("taper", 1.0)] = None
    """Size along the span in place of an even taper: pairs of the share of the span and the size over that of the root."""
    model: Annotated[str, MODEL] = "blade"
    """"blade": as it is; "thesis": as the thesis computes it."""
    shear: Annotated[str, THEORY] = "higher_order"
    """"higher_order", "first_order" or "rigid"."""
    shear_flow: Annotated[str | None, FLOW] = None
    """"consistent": constant around the cell; "thesis": without the couplings of off-axis plies. None: that of the model."""
    steady_state: Annotated[str | None, STEADY_STATE] = None
    """What the blade vibrates about when it turns, "nonlinear" or "linear". None: "nonlinear", the blade at rest in the thesis."""
    terms: Annotated[int | None, TERMS] = None
    """Trial functions of each field. None: 16, or 10 in the thesis' model."""
    discretisation: Annotated[str, DISCRETISATION] = "galerkin"
    """What fields are made of along the span: "galerkin", polynomials over all of it, or "finite-elements"."""
    elements: Annotated[int | None, ELEMENTS] = None
    """Finite elements along the span, at least: each piece between edges of inlays has whole ones, and beside the clamp they are
    short. None: 12."""
    element_order: Annotated[int | None, ELEMENT_ORDER] = None
    """Polynomial order of a finite element, of one more where the energies have second derivatives. None: 4."""
    mesh: Annotated[tuple[float, ...] | None, MESH] = None
    """Ends of finite elements, shares of the span from 0 to 1; edges of inlays are ends as well. None: by ``elements``."""
    inlays: tuple[InstanceOf[Inlay], ...] = ()
    """Foreign material let into the walls, with its mass and stiffness."""
    temperature: Annotated[float | None, BLADE_KELVIN] = None
    """K, of the blade and its inlays. None: that at which their data hold and nothing is strained; with a difference, that of
    reference."""
    temperature_table: Annotated[Steps | None, TABLE, InsteadOf("temperature", None)] = None
    """Temperature along the span in place of one: pairs of the share of the span, from 0 to 1, and K."""
    temperature_difference: Annotated[float, DIFFERENCE] = 0.0
    """K: at the greatest y of each section less that at its least, straight in between."""
    reference_temperature: Annotated[float, BLADE_KELVIN] = ROOM
    """K: at which the blade is free of thermal strain."""
    tip_springs: Annotated[tuple[float, ...] | None, SPRINGS] = None
    """What holds the tip: N/m along lag, flap and span, N m/rad about them. None: nothing does."""

    def __post_init__(self) -> None:
        self.layup.check_walls(self.section.wall_names)
        check_discretisation(self)
        check_table("beam.twist_table", self.twist_table)
        check_table("beam.chord_table", self.chord_table, least=0.0)
        self.section.check_thickness(self.narrowest, "section.thickness")
        self.section.check_corners(self.narrowest, "section.")
        checked_flow(self.model, self.shear_flow)
        if self.model == "thesis":
            self.section.check_one_cell()
            for name in ("twist_table", "chord_table"):
                if getattr(self, name) is not None:
                    raise Refused(f"beam.{name}", getattr(self, name), "None in the thesis' model")
        check_steady_state(self.model, self.steady_state)
        check_held_and_heated(self.model, self)
        plies = (ply for wall in self.section.wall_names for ply in self.layup.plies(wall))
        check_data(self, (ply.material for ply in (*plies, *(inlay.ply for inlay in self.inlays))), "beam")
        self.room.check(self.inlays)

    @property
    def temperatures(self) -> Steps | None:
        """Shares of the span and the temperature (K) there; None where there is none."""
        return temperatures_of(self.temperature, self.temperature_table, self.temperature_difference, self.reference_temperature)

    @property
    def narrowest(self) -> float:
        """Size of the section where it is smallest, over that at the root, or 1."""
        return self.planform.narrowest

    @property
    def room(self) -> Room:
        """What there is for inlays."""
        return Room(self.section, self.length, self.narrowest, self.model == "thesis")

    @cached_property
    def planform(self) -> Planform:
        """How the section is turned and scaled along the span."""
        twists = self.twist_table and tuple((share, float(np.radians(angle))) for share, angle in self.twist_table)
        even = float(np.radians(self.pretwist_deg)), float(np.radians(self.presetting_deg)), self.taper
        covered = max((inlay.start + inlay.length for inlay in self.inlays), default=0.0)
        return Planform(self.length, *even, twists, self.chord_table, covered, self.temperatures)

    @cached_property
    def space(self) -> SpanSpace:
        """What the fields are made of along the span."""
        rigid, warping = self.shear == "rigid", self.model == "blade"
        plane, reach = not self.layup.walls and self.section.stays_plane, self.clamp_reach
        if self.discretisation == "finite-elements":
            edges = [*self._edges, *(piece.start for piece in self.planform.pieces)]
            return element_space(
                self, edges, reach if warping else self.section.thickness, rigid=rigid, warping=warping, plane=plane
            )
        return TrialSpace(
            length=self.length,
            terms=terms_of(self.model, self.terms),
            rigid=rigid,
            warping=warping,
            plane=plane,
            clamp_reach=reach,
            breaks=breaks(self.section, self.planform, self.inlays) if warping and not rigid else (),
        )

    @property
    def clamp_reach(self) -> float:
        """m: distance from the clamp over which sections come to warp at will."""
        return CLAMP_REACH * self.section.perimeter

    @cached_property
    def exact(self) -> ExactBeam:
        """The geometrically exact beam on solid sections: what the blade's model computes with."""
        beside_clamp = CLAMP_PIECE * self.clamp_reach
        changes = [piece.start for piece in self.planform.pieces]
        ends = self.breakpoints([*self._edges, *changes, beside_clamp])
        return ExactBeam(
            space=self.space,
            stations=self.space.stations(ends, self.stations_per_span, graded=True),
            sections=SectionsAlong.build(self.section, self.layup, self.planform, self.inlays),
            hub_radius=self.hub_radius,
            nonlinear=self.steady_state == "nonlinear" or (self.steady_state is None and self.shear != "rigid"),
            heat=None if self.temperatures is None else Heat(self.reference_temperature, self.temperature_difference),
            springs=TipSprings.of(self.space, self.tip_springs) if self.tip_springs else None,
        )

    @cached_property
    def matrices(self) -> BeamMatrices:
        """M, K_e, K_Ω, G₁: assembled once, good at any speed; under the stresses of a linear steady state in the blade's model."""
        with in_scale("beam"):
            matrices = self.exact.matrices if self.model == "blade" else self._wall_matrices()
        if not matrices.regular:
            self._check_springs()
            raise ValueError(f"beam cannot be computed: {OUT_OF_SCALE}")
        return matrices

    def _check_springs(self) -> None:
        """``ValueError`` names the springs where they are why there are no matrices."""
        if self.tip_springs is None:
            return
        try:
            _ = replace(self, tip_springs=None).matrices
        except ValueError:
            return
        raise Refused(
            "beam.tip_springs", list(self.tip_springs), "softer: beside them the blade's own stiffness is lost in rounding"
        )

    def _wall_matrices(self) -> BeamMatrices:
        stations = self.space.stations(self.breakpoints(self._edges), self.stations_per_span)
        walls = self.walls_at(stations.z)
        return assemble(self.space, stations, walls.stiffness(), walls.inertia(), self.hub_radius)

    @property
    def stations_per_span(self) -> int:
        """Gauss stations on a piece as long as the span: for the trial functions, and for pretwist beyond a quarter of a turn."""
        turned = self.planform.turned - 0.5 * np.pi
        return self.space.order + EXTRA_STATIONS + max(0, int(np.ceil(turned)))

    @property
    def _edges(self) -> list[float]:
        return [edge for inlay in self.inlays for edge in (inlay.start, inlay.start + inlay.length)]

    def at(self, speed: float) -> OperatingPoint:
        """M, K, G and the steady state at a speed, rad/s; ``ValueError`` for a negative one, and where there is none below the
        critical speed.

        From the critical speed on, and in the thesis' model, K_e + Ω² K_Ω and Ω G₁.
        """
        speed = checked("speed", speed, SPEED)
        if self.model == "thesis" or speed >= self.critical_speed:
            matrices = self.matrices
            with in_scale("beam"):
                return OperatingPoint(speed, matrices.mass, matrices.stiffness(speed), speed * matrices.gyroscopic, None)
        known: dict[float, OperatingPoint] = self.__dict__.setdefault("_latest_points", {})
        if speed not in known:
            with in_scale("beam"):
                point = self.exact.at(speed)
            if len(known) > 1:  # one speed and rest are asked for in turn
                del known[next(each for each in known if each != 0.0)]
            known[speed] = point
        return known[speed]

    def breakpoints(self, edges: list[float]) -> Array:
        """Ascending span coordinates of root, tip and the given edges, without repetition."""
        return breakpoints(edges, self.length)

    def walls_at(self, z: Array, cuts: tuple[Strip, ...] = ()) -> SpanWalls:
        """The walls at stations z (m) by the thesis' kinematics, split at the edges of strips too."""
        tip = 1.0 / self.taper
        return self.section.walls_at(
            self.section.hosts(self.layup),
            z=z,
            scale=tip + (1.0 - tip) * (1.0 - z / self.length),
            angle=np.radians(self.presetting_deg + self.pretwist_deg * z / self.length),
            shear=self.shear,
            shear_flow=checked_flow(self.model, self.shear_flow),
            inlays=self.inlays,
            cuts=cuts,
        )

    @cached_property
    def critical_speed(self) -> float:
        """Speed (rad/s) at which K_e + Ω² K_Ω is first singular: in the thesis' model spin softening has then used up the stiffness
        of the extension. A non-linear steady state may end, or be unstable, at a lower one.
        """
        return critical_speed(self.matrices.elastic_stiffness, self.matrices.spin_stiffness)

    def natural_frequencies(
        self, speed: float = 0.0, count: int = 6, motions: tuple[str, ...] | None = None, gyroscopic: bool = True
    ) -> Array:
        """Natural frequencies in rad/s, ascending, (count,); zero for a mode that has lost its stiffness.

        ``motions`` keeps only some of lag, flap, extension, twist, each with its section rotation.
        """
        point, count = self._selected(speed, count, motions)
        if checked("gyroscopic", gyroscopic, Flag()) and np.any(point.gyroscopic):
            return whirling_frequencies(point.mass, point.gyroscopic, point.stiffness)[:count]
        return normal_modes(point.mass, point.stiffness, count)[0]

    def modes(self, speed: float = 0.0, count: int = 6, motions: tuple[str, ...] | None = None, gyroscopic: bool = True) -> Modes:
        """Frequencies, mode shapes and families of the first ``count`` modes at a speed in rad/s below the critical one."""
        point, count = self._selected(speed, count, motions)
        shapes: Array | NDArray[np.complex128]
        if checked("gyroscopic", gyroscopic, Flag()) and speed:
            if speed >= self.critical_speed:
                raise Refused("speed", speed, f"below the critical speed, {self.critical_speed:.6g} rad/s")
            frequencies, shapes = whirling_modes(point.mass, point.gyroscopic, point.stiffness, count)
        else:
            frequencies, shapes = normal_modes(point.mass, point.stiffness, count)
        full = self._all_coefficients(shapes, motions)
        blocks = [self.space.columns((motion,)) for motion in MOTIONS]
        participation = energy_participation(self.at(speed).mass, full, blocks)
        names = list(MOTIONS)
        families = tuple(names[k] for k in participation.argmax(axis=1))
        return Modes(frequencies, full, families, participation)

    def _selected(self, speed: float, count: int, motions: tuple[str, ...] | None) -> tuple[OperatingPoint, int]:
        speed = checked("speed", speed, SPEED)
        columns = self.space.columns(motions)
        count = checked("count", count, Count(1, len(columns)))
        return self.at(speed) if motions is None else self.at(speed).restricted(columns), count

    def _all_coefficients(
        self, shapes: Array | NDArray[np.complex128], motions: tuple[str, ...] | None
    ) -> Array | NDArray[np.complex128]:
        full: Array | NDArray[np.complex128] = np.zeros((self.space.size, shapes.shape[1]), dtype=np.result_type(shapes))
        full[self.space.columns(motions)] = shapes
        return full

    def checked_stations(self, z: Any) -> Array:
        """Z (stations,) in m; ``ValueError`` for what is not on the blade."""
        stations = np.atleast_1d(real_numbers("z", z))
        if stations.ndim != 1 or not np.all((stations >= -SHORTEST * self.length) & (stations <= (1.0 + SHORTEST) * self.length)):
            raise Refused("z", z, f"distances from the clamp, from 0 to {self.length:g} m, in one row")
        return stations

    def displacements(self, z: ArrayLike) -> dict[str, Array]:
        """Rows (stations, N) that give u, v, s, theta_x, theta_y, phi at z (m) from the coefficient vector."""
        rows = self.space.evaluate(self.checked_stations(z))
        return {name: rows[name, 0] for name in ("u", "v", "s", "theta_x", "theta_y", "phi")}

    def surface_strain(self, z: Array, speed: float = 0.0) -> Array:
        """Rows (stations, points, N): spanwise strain at points of the outer face, at z (m), of vibration at a speed in rad/s."""
        z = self.checked_stations(z)
        if self.model == "blade":
            face = self.exact.sections.at(z, self.exact.sections.solid.face_strain)
            return np.asarray(face @ self.exact.section_strains(z, self.at(speed)))
        walls = self.walls_at(z)
        outer = 0.5 * walls.laws.thickness[..., None]
        rows = walls.strain_rows()
        at_face = rows[..., 0, :] + outer * rows[..., 1, :] + outer**3 * rows[..., 2, :]
        return np.asarray(at_face @ generalised_strains(self.space.evaluate(z)))

    def steady_strain(self, z: Array, speed: float) -> Array:
        """(stations, points): spanwise strain at the points of ``surface_strain`` as the blade turns and nothing vibrates; zero in
        the thesis' model, which leaves it out.
        """
        z = self.checked_stations(z)
        if self.model == "thesis":
            return np.zeros(self.surface_strain(z).shape[:2])
        face = self.exact.sections.at(z, self.exact.sections.solid.face_strain)
        strain = np.asarray((face @ self.exact.steady_strains(z, self.at(speed))[..., None])[..., 0])
        return strain if self.exact.heat is None else strain + self.exact.heat.face_strain(z, self.exact.sections)

    def line_load(self) -> Array:
        """Generalised force (N, 2) per N/m of uniform line load in lag and in flap."""
        stations = self.space.stations(np.array([0.0, self.length]), self.space.order + EXTRA_STATIONS)
        rows = self.space.evaluate(stations.z)
        return np.column_stack([stations.weight @ rows["u", 0], stations.weight @ rows["v", 0]])
