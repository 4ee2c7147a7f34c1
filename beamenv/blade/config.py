"""Configurations of a blade: frozen dataclasses that hold what a user says of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

from pydantic_core import CoreSchema, core_schema

from beamenv.blade.electronics import ElectronicsConfig
from beamenv.blade.fit import in_words
from beamenv.blade.load_shapes import LoadShape
from beamenv.blade.units import LEAST, check_moduli, check_units, laminae
from beamenv.configuration import (
    Choice,
    Count,
    Flag,
    Instance,
    Items,
    Number,
    Positive,
    Refused,
    Variant,
    Variants,
    Whole,
    checked,
    configuration,
)
from beamenv.configuration.instead import InsteadOf
from beamenv.configuration.kinds import JsonSchema, Kind, plain
from beamenv.configuration.numbers import DEGREES
from beamenv.configuration.sentence import in_millimetres
from beamenv.patches import PatchLayout
from beamenv.patches.layout import SIDES
from beamenv.plant.limits import VOLTAGES
from beamenv.sensors.kinds import SENSORS, Accelerometer, PatchCurrent, Sensor
from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam
from beamenv.structure.beam import TERMS
from beamenv.structure.discretisation import DISCRETISATION, ELEMENT_ORDER, ELEMENTS, MESH, check_discretisation
from beamenv.structure.held_and_heated import (
    BLADE_KELVIN,
    DIFFERENCE,
    SPRINGS,
    check_data,
    check_expansion,
    check_held_and_heated,
    temperatures_of,
)
from beamenv.structure.model import FLOW, MODEL, STEADY_STATE, check_steady_state, checked_flow
from beamenv.structure.planform import TABLE, Steps
from beamenv.structure.section.section import THEORY, Section
from beamenv.structure.section.shapes import SHAPES, AnySection
from beamenv.structure.sizes import HUB, SPAN, WALL, WIDTH
from beamenv.structure.walls.curves import ROOM
from beamenv.structure.walls.graded import FunctionallyGraded
from beamenv.structure.walls.inlay import Inlay
from beamenv.structure.walls.laminate import PLY_ANGLES
from beamenv.structure.walls.named import MATERIALS

ON_EVERY_WALL = "all"

STRAIN_LIMIT = Choice(("vibration", "total"))


@dataclass(frozen=True, slots=True)
class PlyAngles(Kind):
    """Ply angles of all walls, a list, or wall by wall, a mapping of lists; kept as pairs, for ("all", angles) or each wall."""

    @property
    def allowed(self) -> str:
        """Both forms."""
        return f"{PLY_ANGLES.allowed}, or such a list for each wall, every wall once"

    def core(self) -> CoreSchema:
        """Pairs of a wall and its angles."""
        wall = core_schema.tuple_schema([core_schema.str_schema(strict=True), PLY_ANGLES.inner()], strict=True)
        walls = core_schema.tuple_variable_schema(wall, min_length=1, strict=True)
        return core_schema.no_info_after_validator_function(
            _each_once, core_schema.no_info_before_validator_function(_by_wall, walls)
        )

    def json(self) -> JsonSchema:
        """An array, or an object of arrays."""
        angles = PLY_ANGLES.json()
        walls = {"type": "object", "additionalProperties": angles, "minProperties": 1}
        pair = {"type": "array", "prefixItems": [{"type": "string"}, angles], "minItems": 2, "maxItems": 2}
        return {"anyOf": [angles, walls, {"type": "array", "items": pair, "minItems": 1}]}


def _by_wall(value: Any) -> Any:
    value = plain(tuple(value.items()) if isinstance(value, Mapping) else value)
    pairs = isinstance(value, tuple) and value and all(isinstance(each, tuple) for each in value)
    return value if pairs else ((ON_EVERY_WALL, value),)


def _each_once(walls: tuple[tuple[str, tuple[float, ...]], ...]) -> tuple[tuple[str, tuple[float, ...]], ...]:
    if len({wall for wall, _ in walls}) < len(walls):
        raise ValueError
    return walls


@configuration("blade.beam")
class BeamConfig:
    """The bare blade: a box of the thesis (§3.5) unless said otherwise."""

    length: Annotated[float, SPAN] = 2.023
    """m."""
    width: Annotated[float, WIDTH] = 0.254
    """m, of the mid-line box along the chord."""
    depth: Annotated[float, WIDTH] = 0.0508
    """m, of the mid-line box."""
    thickness: Annotated[float, WALL] = 0.01016
    """m, of the walls."""
    hub_radius: Annotated[float, HUB] = 0.2023
    """m."""
    material: Annotated[str | Lamina | FunctionallyGraded, Choice(MATERIALS, (Lamina, FunctionallyGraded), LEAST)] = (
        "graphite-epoxy"
    )
    """A name, a lamina, or a FunctionallyGraded through the walls; in a dictionary or file also a table of a lamina's fields, which
    completes from the material before, or of ``inner``, ``outer`` and ``exponent``."""
    ply_angles_deg: Annotated[tuple[tuple[str, tuple[float, ...]], ...], PlyAngles()] = ((ON_EVERY_WALL, (30.0,) * 6),)
    """Degrees from the contour tangent, inner to outer face, for ("all", angles) or wall by wall; a list or a mapping will do."""
    pretwist_deg: Annotated[float, DEGREES] = 30.0
    presetting_deg: Annotated[float, DEGREES] = 0.0
    taper: Positive = 1.0
    shear: Annotated[str, THEORY] = "higher_order"
    shear_flow: Annotated[str | None, FLOW] = None
    """Shear flow around the closed cell. None: that of the model, which is "consistent", or "thesis" in the thesis' model."""
    steady_state: Annotated[str | None, STEADY_STATE] = None
    """The steady state about which the turning blade vibrates. None: "nonlinear"; the thesis' model has only the blade at rest."""
    terms: Annotated[int | None, TERMS] = None
    """Trial functions of each field along the span; None: 16, or 10 in the thesis' model."""
    discretisation: Annotated[str, DISCRETISATION] = "galerkin"
    """What fields are made of along the span: "galerkin", polynomials over all of it, or "finite-elements"."""
    elements: Annotated[int | None, ELEMENTS] = None
    """Least number of finite elements along the span. None: 12."""
    element_order: Annotated[int | None, ELEMENT_ORDER] = None
    """Polynomial order of a finite element; None: 4."""
    mesh: Annotated[tuple[float, ...] | None, MESH] = None
    """Ends of finite elements, shares of the span from 0 to 1, beside the edges of patches; None: by ``elements``."""
    section: Annotated[AnySection | None, Variant("shape", SHAPES)] = None
    """A section of any shape, in a file a table with a ``shape`` and its fields; None: the box of width, depth and thickness."""
    twist_table: Annotated[Steps | None, TABLE, InsteadOf("pretwist_deg", 0.0)] = None
    """Pretwist along the span in place of ``pretwist_deg``: pairs of the share of the span, from 0 to 1, and degrees."""
    chord_table: Annotated[Steps | None, TABLE, InsteadOf("taper", 1.0)] = None
    """Size along the span in place of ``taper``: pairs of the share of the span and the size over that of the root."""
    temperature: Annotated[float | None, BLADE_KELVIN] = None
    """K, of the blade and its patches. None: the temperature at which all data hold and nothing is strained; with a
    ``temperature_difference``, the ``reference_temperature``."""
    temperature_table: Annotated[Steps | None, TABLE, InsteadOf("temperature", None)] = None
    """Temperature along the span in place of ``temperature``: pairs of the share of the span, from 0 to 1, and K."""
    temperature_difference: Annotated[float, DIFFERENCE] = 0.0
    """K: temperature at the greatest y of each section (the top wall) minus that at the least y, linear in between."""
    reference_temperature: Annotated[float, BLADE_KELVIN] = ROOM
    """K: at which the blade is free of thermal strain."""
    tip_springs: Annotated[tuple[float, ...] | None, SPRINGS] = None
    """What holds the tip: N/m along lag, flap and span, N m/rad about them. None: nothing does."""

    def __post_init__(self) -> None:
        check_discretisation(self)
        check_moduli(self.material)
        check_held_and_heated("blade", self, "blade.beam")
        if self.temperatures is not None:
            check_data(self, [self.wall_material], "blade.beam")
            for path, lamina in laminae(self.material):
                check_expansion(path, lamina)

    @property
    def temperatures(self) -> Steps | None:
        """Shares of the span and the temperature (K) there; None where there is none."""
        return temperatures_of(self.temperature, self.temperature_table, self.temperature_difference, self.reference_temperature)

    @property
    def wall_material(self) -> Lamina | FunctionallyGraded:
        """That of the walls, itself."""
        return MATERIALS[self.material] if isinstance(self.material, str) else self.material

    @property
    def root_section(self) -> Section:
        """The section at the root."""
        if self.section is not None:
            return self.section
        try:
            return BoxSection(self.width, self.depth, self.thickness)
        except Refused as refused:
            name = refused.name.replace("section", "blade.beam", 1)  # whose numbers these are
            raise Refused(name, refused.value, refused.allowed, in_millimetres(float(refused.value), self.depth)) from None

    def build(self, layout: PatchLayout | None = None, model: str = "blade") -> RotatingBeam:
        """The blade in a ``BladeConfig``'s model, with the inlays of passive patches when a layout is given."""
        if layout is None:
            return self._with((), model)
        inlays = checked("layout", layout, Instance(PatchLayout)).inlays(self.length)
        try:
            return self._with(inlays, model)
        except ValueError as error:
            refused = error
        raise in_words(refused, layout, self._with((), model).room, self.section is None)

    def _with(self, inlays: tuple[Inlay, ...], model: str) -> RotatingBeam:
        return RotatingBeam(
            section=self.root_section,
            layup=self.layup(),
            length=self.length,
            hub_radius=self.hub_radius,
            pretwist_deg=self.pretwist_deg,
            presetting_deg=self.presetting_deg,
            taper=self.taper,
            twist_table=self.twist_table,
            chord_table=self.chord_table,
            temperature=self.temperature,
            temperature_table=self.temperature_table,
            temperature_difference=self.temperature_difference,
            reference_temperature=self.reference_temperature,
            tip_springs=self.tip_springs,
            model=model,
            shear=self.shear,
            shear_flow=self.shear_flow,
            steady_state=self.steady_state,
            terms=self.terms,
            discretisation=self.discretisation,
            elements=self.elements,
            element_order=self.element_order,
            mesh=self.mesh,
            inlays=inlays,
        )

    def layup(self) -> Layup:
        """The plies of every wall."""
        material = self.wall_material
        walls = dict(self.ply_angles_deg)
        if set(walls) == {ON_EVERY_WALL}:
            return Layup.uniform(material, walls[ON_EVERY_WALL])
        names = self.root_section.wall_names
        if set(walls) != set(names):
            raise Refused("blade.beam.ply_angles_deg", sorted(walls), f"for every wall of the section: {', '.join(names)}")
        return Layup.by_wall(material, **walls)


@configuration("blade")
class BladeConfig:
    """A rotating blade with its patches and electronics: everything a plant is built from."""

    beam: BeamConfig = field(default_factory=BeamConfig)
    patches: PatchLayout = field(default_factory=PatchLayout)
    model: Annotated[str, MODEL] = "blade"
    """"blade": the blade as it is; "thesis": all of the thesis' assumptions, with which its tables and figures are reproduced."""
    speed: Annotated[float, Number(ge=0.0, unit="rad/s")] = 200.0
    """rad/s."""
    modes: Whole = 11
    """Number of modes of the plant that controllers are designed for: as many as a pretwisted blade's tip displacement and voltages
    need (thesis Fig. 5.2)."""
    gyroscopic: Annotated[bool, Flag()] = True
    damping_ratio: Annotated[float, Number(ge=0.0, lt=1.0)] = 0.01
    """Of every mode."""
    effort_weight: Annotated[float, Number(ge=1e-9, le=1e9)] = 0.5
    """ρ in R = ρ FᵀK⁻¹F: with ½, uᵀRu is the energy (J) that the actuators store in the blade at rest."""
    strain_limit: Annotated[str, STRAIN_LIMIT] = "vibration"
    """The strain that must not exceed what the patches bear: that of "vibration" alone, or the "total", which includes the steady
    state's. Beyond it the blade fails."""
    white_load: Annotated[float, Number(ge=0.0, le=1e6, unit="N/m")] = 3.0
    """N/m: standard deviation, in lag and in flap, of the white line load of each interval, for a blade whose reference load is
    30 N/m; it is scaled in proportion to the reference load."""
    reference_load: Annotated[float | None, Number(ge=1e-9, le=1e6, unit="N/m")] = None
    """N/m: the load that stands for 30 N/m of a scenario. All loads, the white one and the sensors' range are scaled by it. None:
    30 for a box of the thesis' size; for any other blade, five times what its patches can hold (``beamenv.blade.held_load``)."""
    sensor_noise_fraction: Annotated[float, Number(ge=0.0, le=100.0)] = 0.02
    """Standard deviation of one sample over the sensors' full scale."""
    sensor_full_scale: Annotated[float | None, Number(ge=1e-15, le=1e6, unit="A")] = None
    """A: the range of the data acquisition, which also sets its noise. Give it to keep the instrument while patches move. None: by
    the largest current that a sudden reference load causes."""
    voltage_limits: Annotated[tuple[float, float], VOLTAGES] = (-1500.0, 1500.0)
    """V, as in the thesis; the data sheet of the MFC has −500 … 1500 V."""
    sensors: Annotated[tuple[Sensor, ...], Variants("kind", SENSORS)] = ()
    """What is read, in this order: tables with a ``kind`` and its fields (``beamenv.sensors.kinds``). Empty: the currents of all
    sensor patches."""
    loads: Annotated[tuple[LoadShape, ...], Items(LoadShape)] = ()
    """Where further loads act on the true blade; a scenario with loads of its own fills this in, and says how large they are."""
    electronics: ElectronicsConfig = field(default_factory=ElectronicsConfig)
    truth_modes: Annotated[int | None, Count()] = None
    """Number of modes of the plant that moves. None: all up to the Nyquist frequency π/``control_interval``, and no fewer than
    ``modes``; in the thesis' model ``modes``."""
    control_interval: Annotated[float, Number(ge=1e-6, le=1.0, unit="s")] = 0.5e-3
    """s: 1.4 rad, or between four and five samples a period, of the eleventh mode (2.7 krad/s)."""

    def __post_init__(self) -> None:
        check_units(self.beam)
        checked_flow(self.model, self.beam.shear_flow, "beam.shear_flow")
        check_held_and_heated(self.model, self.beam, "blade.beam")
        sheets = (group.patch for side in SIDES for group in self.patches.groups(side))
        check_data(self.beam, sheets, "blade.beam")
        if self.beam.temperatures is not None:
            for path, group in self.patches.named_groups():
                if group.passive:
                    check_expansion(f"{path}.material.lamina", group.patch.lamina)
        check_steady_state(self.model, self.beam.steady_state, "beam.steady_state")
        if self.strain_limit == "total" and self.model == "thesis":
            raise Refused("strain_limit", self.strain_limit, "'vibration' with model = 'thesis', which has no steady state")
        if self.sensors and self.model == "thesis":
            raise Refused(
                "sensors", [each.kind for each in self.sensors], "empty with model = 'thesis', which reads currents alone"
            )
        if self.sensor_full_scale is not None and self.sensors and not any(isinstance(each, PatchCurrent) for each in self.sensors):
            raise Refused(
                "sensor_full_scale", self.sensor_full_scale, "None (A) where the sensors that are listed read no currents"
            )
        if not self.sensors and not self.patches.groups("sensors"):
            raise Refused("sensors", [], "a list of one or more where no patches are sensors")
        if any(isinstance(each, Accelerometer) for each in self.sensors) and self.electronics.filter_cutoff is None:
            raise Refused("electronics.filter_cutoff", None, "a number where accelerometers, which feel loads at once, are read")
