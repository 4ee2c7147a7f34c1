"""Doors of the blade: materials, sections, beams, patches, configurations, plants."""

import dataclasses

import numpy as np
from hypothesis import strategies as st

import beamenv
from beamenv.blade import BeamConfig, BladeConfig
from beamenv.blade.build import Blade
from beamenv.blade.electronics import ElectronicsConfig
from beamenv.patches import PatchLayout
from beamenv.patches.material import MFC, PatchMaterial
from beamenv.plant.files import load_plant
from beamenv.plant.modal_plant import SENSED, STATIC, ModalPlant
from beamenv.plant.plant import Plant, SampledPlant
from beamenv.scenarios.scenario import Scenario, scenario
from beamenv.scenarios.tables import Acquisition, Drive, Failures, PlantVariation, Rotor
from beamenv.structure import ALUMINIUM, GRAPHITE_EPOXY, BoxSection, FunctionallyGraded, Lamina, Layup, RotatingBeam
from beamenv.structure.section.section import Section
from beamenv.structure.walls.curves import Touloukian
from tests.fuzz import small
from tests.fuzz.meaning import (
    ANYTHING,
    ARRAY,
    COUNT,
    CURVES,
    FLAG,
    MATRIX,
    NOTHING,
    NUMBER,
    NUMBERS,
    TEXT,
    Kind,
    either,
    instance,
    maybe,
    of_fields,
    table,
)
from tests.fuzz.oracle import Door


def vars_of(made):
    return {each.name: getattr(made, each.name) for each in dataclasses.fields(made)}


def constructor(cls, valid, told=(), read=lambda made: made, **changes):
    """Of a class that checks its fields: each reads back as it was given."""
    kinds = {**of_fields(cls, tables=False), **changes}
    return Door(cls.__name__, lambda **given: cls(**given), kinds, lambda: dict(valid), read, told, public=cls.__name__)


LAMINA = {each.name: getattr(GRAPHITE_EPOXY, each.name) for each in dataclasses.fields(GRAPHITE_EPOXY)}
CORNERS = Kind(
    "corners",
    lambda value: (
        tuple(read)
        if (items := _rows(value)) is not NOTHING and all(read := [*map(_pair, items)]) and NOTHING not in read
        else NOTHING
    ),
    st.nothing(),
)
BOX = BoxSection(0.254, 0.0508, 0.01016)
LAYUP = Layup.uniform(GRAPHITE_EPOXY, [30.0] * 6)
GRADED = FunctionallyGraded("sus304", "silicon-nitride", 1.0)
METAL = Layup.uniform(ALUMINIUM, [0.0])


def _rows(value):
    return list(value) if isinstance(value, (list, tuple, np.ndarray)) and np.ndim(value) != 0 else NOTHING


def _pair(value):
    read = NUMBERS.means(value)
    return read if read is not NOTHING and len(read) == 2 else NOTHING


def modal():
    shipped = load_plant("solid-blade").first(2)
    return {
        each.name: getattr(shipped, each.name) for each in dataclasses.fields(shipped) if getattr(shipped, each.name) is not None
    }


def material_parts():
    parts = of_fields(BladeConfig)
    beam = dict(parts["beam"].parts)
    lamina, graded = table(of_fields(Lamina), Lamina), table(of_fields(FunctionallyGraded), FunctionallyGraded)
    beam["material"] = dataclasses.replace(either(TEXT, lamina, graded), parts={**lamina.parts, **graded.parts})
    patches = dict(parts["patches"].parts)
    return {
        **parts,
        "beam": dataclasses.replace(parts["beam"], parts=beam, means=table(beam, BeamConfig).means),
        "patches": dataclasses.replace(parts["patches"], parts=patches),
    }


BLADE_PARTS = material_parts()
BLADE = table(BLADE_PARTS, BladeConfig)
SCENARIO_PARTS = {**of_fields(Scenario), "preset": TEXT}
SCENARIO = table(SCENARIO_PARTS, Scenario)


def read_scenario(made):
    return {"given": made}


def plant_fields(cls, made):
    return {each.name: getattr(made, each.name) for each in dataclasses.fields(cls)}


DOORS = [
    constructor(Lamina, LAMINA),
    Door(
        "Lamina.isotropic",
        Lamina.isotropic,
        {"E": NUMBER, "nu": NUMBER, "density": NUMBER, "alpha": maybe(NUMBER), "curves": CURVES},
        lambda: {"E": 7e10, "nu": 0.3, "density": 2700.0, "alpha": 2e-5, "curves": {"E1": [[200, 1.1], [300, 1.0]]}},
        lambda made: {"E": made.E1, "nu": made.nu12, "density": made.density, "alpha": made.alpha1, "curves": made.curves},
    ),
    constructor(FunctionallyGraded, {"inner": "sus304", "outer": ALUMINIUM, "exponent": 0.5, "scheme": "mori-tanaka"}),
    Door("FunctionallyGraded.at", GRADED.at, {"temperature_K": NUMBER}, lambda: {"temperature_K": 350.0}, told=("temperature",)),
    constructor(Touloukian, {"least_K": 300.0, "most_K": 900.0, "P_minus1": 0.0, "P1": 3e-4, "P2": -6e-7, "P3": 0.0}),
    Door("Lamina.at", ALUMINIUM.at, {"temperature_K": NUMBER}, lambda: {"temperature_K": 350.0}, told=("temperature",)),
    Door("Layup.at", METAL.at, {"temperature_K": NUMBER}, lambda: {"temperature_K": 350.0}, told=("temperature",)),
    Door(
        "Layup.uniform",
        Layup.uniform,
        {"material": instance(Lamina, FunctionallyGraded), "angles_deg": NUMBERS},
        lambda: {"material": GRAPHITE_EPOXY, "angles_deg": [30.0, -30.0]},
        lambda made: {"angles_deg": [ply.angle_deg for ply in made.default]},
        public="Layup",
    ),
    Door(
        "Layup.by_wall",
        lambda material, **walls: Layup.by_wall(material, **walls),
        {"material": instance(Lamina, FunctionallyGraded), "top": NUMBERS, "bottom": NUMBERS},
        lambda: {"material": GRAPHITE_EPOXY, "top": [1.0], "bottom": [2.0, 3.0]},
        lambda made: {wall: [ply.angle_deg for ply in plies] for wall, plies in made.walls.items()},
    ),
    Door(
        "Layup",
        lambda **given: Layup(**given),
        {"default": maybe(instance(tuple)), "walls": instance(dict)},
        lambda: {"default": LAYUP.default, "walls": {}},
        plain=False,
    ),
    constructor(
        RotatingBeam,
        {"section": BOX, "layup": LAYUP, "length": 2.023},
        ("section", "inlay"),
        inlays=ANYTHING,
        section=instance(Section),
    ),
    Door(
        "RotatingBeam.natural_frequencies",
        lambda **given: BEAM.natural_frequencies(**given),
        {
            "speed": NUMBER,
            "count": COUNT,
            "motions": maybe(
                Kind(
                    "motions",
                    lambda v: tuple(v) if isinstance(v, (list, tuple)) and all(isinstance(each, str) for each in v) else NOTHING,
                    st.nothing(),
                )
            ),
            "gyroscopic": FLAG,
        },
        lambda: {"speed": 100.0, "count": 3, "motions": ("lag", "flap"), "gyroscopic": True},
        told=("beam",),
    ),
    Door(
        "RotatingBeam.modes",
        lambda **given: BEAM.modes(**given),
        {"speed": NUMBER, "count": COUNT, "gyroscopic": FLAG},
        lambda: {"speed": 100.0, "count": 3, "gyroscopic": True},
        told=("beam",),
    ),
    Door(
        "Section.stiffness",
        lambda **given: BOX.stiffness(**given),
        {"layup": instance(Layup), "shear": TEXT, "shear_flow": maybe(TEXT), "model": TEXT},
        lambda: {"layup": LAYUP, "shear": "first_order", "shear_flow": "thesis", "model": "thesis"},
    ),
    Door("Section.properties", lambda **given: BOX.properties(**given), {"layup": instance(Layup)}, lambda: {"layup": LAYUP}),
    constructor(BeamConfig, {}, material=either(TEXT, instance(Lamina, FunctionallyGraded))),
    constructor(PatchLayout, {}, material=either(TEXT, instance(PatchMaterial))),
    constructor(PatchMaterial, {each.name: getattr(MFC, each.name) for each in dataclasses.fields(MFC)}),
    Door("PatchMaterial.at", MFC.at, {"temperature_K": NUMBER}, lambda: {"temperature_K": 350.0}, told=("temperature",)),
    constructor(ElectronicsConfig, {}),
    constructor(BladeConfig, {}),
    *(constructor(cls, {}) for cls in (PlantVariation, Drive, Acquisition, Failures, Rotor)),
    constructor(Scenario, {}),
    constructor(
        ModalPlant,
        modal(),
        ("gyroscopic", "load_places", "sensor_list"),
        lambda made: {**vars_of(made), "damping_ratio": NOTHING},
        **{
            name: maybe(ARRAY) if name in ("strain", "damping_ratio", "further_loads", *SENSED, *STATIC) else ARRAY
            for name in (
                *("natural_frequencies", "gyroscopic", "actuation", "charges", "line_load", "tip", "strain", "damping_ratio"),
                *("further_loads", *SENSED, *STATIC),
            )
        },
    ),
    Door(
        "blade_config",
        beamenv.blade_config,
        {"preset": TEXT, "overrides": maybe(BLADE), "speed": maybe(NUMBER)},
        lambda: {"preset": "thesis", "overrides": {}, "speed": None},
        lambda made: {"overrides": made, "speed": made.speed},
        ("blade",),
        public="blade_config",
    ),
    Door(
        "scenario",
        lambda given: scenario(given),
        {
            "given": maybe(
                either_scenario := Kind(
                    "scenario",
                    lambda value: str(value) if isinstance(value, str) and not isinstance(value, bytes) else SCENARIO.means(value),
                    st.sampled_from(["rotor", "no.toml", "x", ""]),
                    SCENARIO_PARTS,
                )
            )
        },
        lambda: {"given": {"preset": "rotor"}},
        read_scenario,
        ("scenario", "path", "file"),
        public="scenario",
    ),
    Door(
        "build_plant",
        beamenv.build_plant,
        {"config": instance(BladeConfig)},
        lambda: {"config": small.config()},
        public="build_plant",
    ),
    Door(
        "modal_plant_of",
        beamenv.modal_plant_of,
        {"config": instance(BladeConfig)},
        lambda: {"config": small.config()},
        public="modal_plant_of",
    ),
    Door(
        "Prior",
        lambda **given: beamenv.Prior(**given),
        {"blade": instance(Blade), "design_blade": instance(Blade), "scenario": instance(Scenario), "steps": COUNT},
        lambda: {"blade": Blade(small.config()), "design_blade": Blade(small.config()), "scenario": scenario(), "steps": 3},
        public="Prior",
    ),
    Door(
        "Design",
        lambda **given: beamenv.Design(**given),
        {"plant": instance(Plant), "config": instance(BladeConfig)},
        lambda: {"plant": small.plant(), "config": small.config()},
        public="Design",
    ),
    Door(
        "sample",
        beamenv.sample,
        {"plant": instance(Plant), "interval": maybe(NUMBER)},
        lambda: {"plant": small.plant(), "interval": 1e-3},
        lambda made: {"interval": made.interval},
        public="sample",
    ),
    Door(
        "Plant",
        lambda **given: Plant(**given),
        {
            **{each.name: MATRIX for each in dataclasses.fields(Plant)},
            "control_interval": NUMBER,
            "time_scale": NUMBER,
            "electronic_states": COUNT,
            **dict.fromkeys(("disturbances", "sensors", "assumed"), ANYTHING),
        },
        lambda: plant_fields(Plant, small.plant()),
        lambda made: made,
        public="Plant",
    ),
    Door(
        "SampledPlant",
        lambda **given: SampledPlant(**given),
        {each.name: MATRIX if each.name != "interval" else NUMBER for each in dataclasses.fields(SampledPlant)},
        lambda: plant_fields(SampledPlant, beamenv.sample(small.plant())),
        lambda made: made,
        public="SampledPlant",
    ),
]
BEAM = RotatingBeam(section=BOX, layup=LAYUP, length=2.023, model="thesis", terms=4)
