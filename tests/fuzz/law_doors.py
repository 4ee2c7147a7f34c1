"""Doors of the classical laws of the nominal plant, and of what they are made of."""

import dataclasses
from functools import cache

import numpy as np
from hypothesis import strategies as st

import baselines
from baselines.design.instruments import Instruments
from baselines.design.linear import MATRICES
from beamenv.blade import BladeConfig
from beamenv.simulation.plants.speed_family import SpeedFamily, speed_family
from tests.fuzz import small
from tests.fuzz.law_kinds import ABOUT, LOAD, LOADS, ONE_LOAD, PLANT, clipped, finite
from tests.fuzz.meaning import (
    ANYTHING,
    ARRAY,
    COUNT,
    COUNTS,
    FLAG,
    MATRIX,
    NOTHING,
    NUMBER,
    NUMBERS,
    TEXT,
    Kind,
    instance,
    maybe,
    of_fields,
)
from tests.fuzz.oracle import Door

WEIGHTS = {"Q": maybe(ARRAY), "R": maybe(ARRAY)}
GAIN = maybe(ARRAY)
SPEEDS = Kind(
    "speeds",
    lambda value: (one,) if (one := NUMBER.means(value)) is not NOTHING else NUMBERS.means(value),
    st.one_of(NUMBERS.near, NUMBER.near),
)


@cache
def family():
    return speed_family(small.config(), [180.0, 200.0])


@cache
def adaptive():
    return baselines.adaptive_neural(small.plant(), settings=baselines.AdaptationSettings(hidden=1, forces=2))


def law(name, kinds=None, /, **valid):
    """A builder of laws from a plant."""
    function = getattr(baselines, name)
    return Door(
        name, function, {"plant": PLANT, **(kinds or {})}, lambda: {"plant": small.plant(), **valid}, told=ABOUT, public=name
    )


def weights():
    plant = small.plant()
    return {"Q": np.array(plant.state_weight), "R": np.array(plant.input_weight)}


def weighted(name, kinds, /, **valid):
    door = law(name, {**kinds, **WEIGHTS}, **valid)
    return dataclasses.replace(door, valid=lambda: {**door.valid(), **weights()}, plain=name != "mpc")  # its solver is an object


def linear_parts():
    built = small.law()
    return {"name": "mine", "instruments": built.instruments, **{name: np.array(getattr(built, name)) for name in MATRICES}}


def instrument_parts():
    built = Instruments.of(small.plant())
    return {each.name: getattr(built, each.name) for each in dataclasses.fields(Instruments)}


DOORS = [
    weighted("lqg", {"design": TEXT, "persistent_load": LOAD}, design="sampled", persistent_load=None),
    weighted("lqr", {"persistent_load": LOAD}, persistent_load=None),
    weighted("clipped_lqg", {"persistent_load": LOAD, "rate_weight": NUMBER}, persistent_load=None, rate_weight=0.1),
    weighted(
        "mpc",
        {"move_blocks": maybe(COUNTS), "persistent_load": LOAD, "rate_weight": NUMBER, "delay": COUNT},
        move_blocks=[1, 1, 2],
        persistent_load=None,
        rate_weight=0.1,
        delay=1,
    ),
    weighted("h_infinity", {"back_off": NUMBER}, back_off=1.5),
    law("no_control"),
    law("velocity_feedback", {"gain": GAIN, "tuned_on": maybe(PLANT)}, gain=[1.0, 2.0], tuned_on=None),
    law(
        "positive_position_feedback",
        {"gain": GAIN, "modes": COUNT, "filter_damping": NUMBER, "leak": NUMBER},
        gain=[0.1, 0.1],
        modes=2,
        filter_damping=0.3,
        leak=0.05,
    ),
    law(
        "full_order_lqg",
        {"rate_weight": NUMBER, "load": maybe(LOADS), "name": TEXT},
        rate_weight=1.0,
        load=None,
        name="LQG",
    ),
    law(
        "reference_lqg",
        {
            "rate_weight": NUMBER,
            "order": maybe(COUNT),
            "load": maybe(LOADS),
            "name": TEXT,
        },
        rate_weight=1.0,
        order=2,
        load=None,
        name="LQG",
    ),
    weighted(
        "rotor_lqg",
        {"harmonics": instance(baselines.RotorHarmonics), "turbulence": LOAD},
        harmonics=baselines.RotorHarmonics(200.0),
        turbulence=None,
    ),
    Door(
        "scheduled_lqg",
        baselines.scheduled_lqg,
        {"family": instance(SpeedFamily), "persistent_load": LOAD, "rate_weight": NUMBER},
        lambda: {"family": family(), "persistent_load": None, "rate_weight": 0.1},
        told=ABOUT,
        public="scheduled_lqg",
    ),
    Door(
        "scheduled_lqg_for",
        baselines.scheduled_lqg_for,
        {"config": instance(BladeConfig), "speeds": maybe(SPEEDS), "persistent_load": LOAD, "full": FLAG, "rate_weight": NUMBER},
        lambda: {"config": small.config(), "speeds": [180.0, 200.0], "persistent_load": None, "full": False, "rate_weight": 0.0},
        told=ABOUT,
        public="scheduled_lqg_for",
    ),
    Door(
        "Detuning",
        lambda **given: baselines.Detuning(**given),
        of_fields(baselines.Detuning),
        dict,
        lambda made: made,
        public="Detuning",
    ),
    Door(
        "detuned_lqg",
        lambda plant, detuning, load, name: baselines.detuned_lqg(plant, detuning, load, name=name),
        {"plant": PLANT, "detuning": instance(baselines.Detuning), "load": ONE_LOAD, "name": TEXT},
        lambda: {"plant": small.plant(), "detuning": baselines.Detuning(), "load": baselines.PersistentLoad(), "name": "mine"},
        told=ABOUT,
        public="detuned_lqg",
    ),
    law(
        "adaptive_neural",
        {"base": maybe(instance(baselines.LinearController)), "settings": maybe(instance(baselines.AdaptationSettings))},
        base=None,
        settings=None,
    ),
    Door(
        "AdaptationSettings",
        lambda **given: baselines.AdaptationSettings(**given),
        of_fields(baselines.AdaptationSettings),
        dict,
        lambda made: made,
        public="AdaptationSettings",
    ),
    Door(
        "AdaptiveNeural.predict",
        lambda **given: adaptive().predict(**given),
        {"observation": MATRIX, "state": maybe(MATRIX)},
        lambda: {"observation": np.array([[0.1, -0.2]]), "state": np.zeros((1, adaptive().order))},
        told=("state",),
        check=finite,
        public="AdaptiveNeural",
    ),
    Door(
        "AdaptiveNeural.adaptation",
        lambda memory: adaptive().adaptation(memory),
        {"memory": ARRAY},
        lambda: {"memory": np.zeros((2, adaptive().order))},
        told=("memory",),
    ),
    Door("AdaptiveNeural.switched", lambda on: adaptive().switched(on), {"on": FLAG}, lambda: {"on": False}),
    Door(
        "PersistentLoad",
        lambda **given: baselines.PersistentLoad(**given),
        of_fields(baselines.PersistentLoad),
        dict,
        lambda made: made,
        public="PersistentLoad",
    ),
    Door(
        "RotorHarmonics",
        lambda **given: baselines.RotorHarmonics(**given),
        of_fields(baselines.RotorHarmonics),
        lambda: {"speed": 200.0},
        lambda made: made,
        public="RotorHarmonics",
    ),
    Door(
        "Instruments",
        lambda **given: Instruments(**given),
        {"measurement_scale": ARRAY, "voltage_scale": ARRAY, "voltage_limits": ARRAY, "interval": NUMBER, "observes": TEXT},
        instrument_parts,
        lambda made: made,
        told=("voltage_limits",),
        public="Instruments",
    ),
    Door(
        "Instruments.of", Instruments.of, {"plant": PLANT, "observes": TEXT}, lambda: {"plant": small.plant(), "observes": "state"}
    ),
    Door(
        "LinearController",
        lambda **given: baselines.LinearController(**given),
        {"name": TEXT, "instruments": instance(Instruments), **dict.fromkeys(MATRICES, ARRAY)},
        linear_parts,
        lambda made: made,
        public="LinearController",
    ),
    Door(
        "Law.predict",
        lambda **given: small.law().predict(**given),
        {"observation": MATRIX, "state": maybe(MATRIX), "episode_start": ANYTHING},
        lambda: {
            "observation": np.array([[0.1, -0.2], [0.3, 0.0]]),
            "state": np.zeros((2, small.law().order)),
            "episode_start": np.array([True, False]),
        },
        told=("state",),
        check=finite,
        public="Law",
    ),
    Door(
        "ClippedLQG.predict",
        lambda **given: clipped().predict(**given),
        {"observation": MATRIX, "state": maybe(MATRIX)},
        lambda: {"observation": np.array([[0.1, -0.2]]), "state": np.zeros((1, clipped().order))},
        told=("state",),
        check=finite,
        public="ClippedLQG",
    ),
]
