"""Doors of the classical laws, of what is said of them, of evaluation and placement."""

import dataclasses
from functools import cache

import numpy as np
from hypothesis import strategies as st

import baselines
from baselines import placement
from baselines.design.instruments import Instruments
from baselines.design.linear import MATRICES
from beamenv.blade import BladeConfig
from beamenv.blade.design import Design
from beamenv.knowledge import Prior, Truth
from beamenv.plant.plant import Plant, SampledPlant
from beamenv.simulation.plants.speed_family import SpeedFamily, speed_family
from tests.fuzz import small
from tests.fuzz.env_doors import cartpole
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
    choice,
    instance,
    maybe,
    of_fields,
)
from tests.fuzz.oracle import Door

PLANT = instance(Plant)
EITHER_PLANT = instance(Plant, SampledPlant)
ONE_LOAD = instance(baselines.PersistentLoad, baselines.RotorHarmonics)
LOADS = Kind(
    "loads",
    lambda value: (
        value
        if ONE_LOAD.means(value) is not NOTHING or (isinstance(value, (list, tuple)) and NOTHING not in map(ONE_LOAD.means, value))
        else NOTHING
    ),
    st.nothing(),
)
LOAD = maybe(instance(baselines.PersistentLoad))
LINEAR = Kind(
    "linear law",
    lambda value: value if isinstance(value, baselines.LinearController) else NOTHING,
    st.sampled_from(["clipped", "true"]).map(lambda name: clipped() if name == "clipped" else small.law().__class__),
)
PLANTS = Kind(
    "plants",
    lambda value: value if isinstance(value, (list, tuple)) and value and all(isinstance(one, Plant) for one in value) else NOTHING,
    st.sampled_from([[], [None], ()]),
)
HYPOTHESES = Kind(
    "hypotheses",
    lambda value: (
        value
        if isinstance(value, (list, tuple)) and value and all(isinstance(each, baselines.Hypothesis) for each in value)
        else NOTHING
    ),
    st.nothing(),
)
WEIGHTS = {"Q": maybe(ARRAY), "R": maybe(ARRAY)}
ABOUT = ("plant", "gain", "Riccati")
"""What a law says of its numbers together."""
GAIN = maybe(ARRAY)
SPEEDS = Kind(
    "speeds",
    lambda value: (one,) if (one := NUMBER.means(value)) is not NOTHING else NUMBERS.means(value),
    st.one_of(NUMBERS.near, NUMBER.near),
)


@cache
def clipped():
    return baselines.clipped_lqg(small.plant())


@cache
def hypotheses():
    return [baselines.Hypothesis(small.plant()), baselines.Hypothesis(small.plant(), sensor_gain=[1.0, 0.0])]


@cache
def several():
    return baselines.multiple_model(hypotheses(), small.law())


@cache
def family():
    return speed_family(small.config(), [180.0, 200.0])


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


def finite(answer):
    """Within the drive limits."""
    action = np.asarray(answer[0])
    assert not np.abs(action).max(initial=0.0) > 1.0 + 1e-6, "an action outside its space"  # what is not finite stays so


def linear_parts():
    built = small.law()
    return {"name": "mine", "instruments": built.instruments, **{name: np.array(getattr(built, name)) for name in MATRICES}}


def instrument_parts():
    built = Instruments.of(small.plant())
    return {each.name: getattr(built, each.name) for each in dataclasses.fields(Instruments)}


ANY_ENV = Kind(
    "env",
    lambda value: value if value is small.envs() or value is small.env() or value == "beamenv/RotatingBeam-v0" else NOTHING,
    st.sampled_from([cartpole]).map(lambda make: make()),
)
CONTROLLER = Kind(
    "controller",
    lambda value: value if callable(getattr(value, "predict", value)) and not isinstance(value, type) else NOTHING,
    st.nothing(),
)


def evaluated(**given):
    return baselines.evaluate(**given).to_dict()


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
    Door(
        "informed_lqg",
        baselines.informed_lqg,
        {"prior": instance(Prior)},
        lambda: {"prior": small.env().unwrapped.task.prior},
        told=("prior",),
        public="informed_lqg",
    ),
    Door(
        "informed_mpc",
        baselines.informed_mpc,
        {"prior": instance(Prior)},
        lambda: {"prior": small.env().unwrapped.task.prior},
        told=("prior",),
        plain=False,
        public="informed_mpc",
    ),
    Door(
        "robust_lqg",
        baselines.robust_lqg,
        {"design": instance(Design)},
        lambda: {"design": small.env().unwrapped.task.design},
        told=("design",),
        public="robust_lqg",
    ),
    Door(
        "run_up_lqg",
        baselines.run_up_lqg,
        {"prior": instance(Prior)},
        lambda: {"prior": small.env().unwrapped.task.prior},
        told=("prior",),
        plain=False,
        public="run_up_lqg",
    ),
    Door(
        "inverse_hysteresis",
        baselines.inverse_hysteresis,
        {"law": LINEAR, "loop": NUMBER},
        lambda: {"law": small.law(), "loop": 0.1},
        told=("law", "loop"),
        plain=False,
        public="inverse_hysteresis",
    ),
    Door(
        "clairvoyant_lqg",
        baselines.clairvoyant_lqg,
        {"truth": instance(Truth)},
        lambda: {"truth": small.env().unwrapped.task.truth},
        told=("truth",),
        plain=False,
        public="clairvoyant_lqg",
    ),
    Door(
        "Hypothesis",
        baselines.Hypothesis,
        {
            "plant": PLANT,
            "delay": COUNT,
            "actuator_gain": ARRAY,
            "sensor_gain": ARRAY,
            "sensor_bias": ARRAY,
            "load": maybe(LOADS),
            "deflection": NUMBER,
            "holds_lost_readings": FLAG,
            "prior": NUMBER,
        },
        lambda: {
            "plant": small.plant(),
            "delay": 1,
            "actuator_gain": [1.0, 0.0],
            "sensor_gain": 1.0,
            "sensor_bias": np.array([0.1, 0.0]),
            "load": None,
            "deflection": 10.0,
            "holds_lost_readings": True,
            "prior": 2.0,
        },
        public="Hypothesis",
    ),
    Door(
        "multiple_model",
        baselines.multiple_model,
        {
            "hypotheses": HYPOTHESES,
            "fallback": maybe(LINEAR),
            "transition": maybe(ARRAY),
            "rate_weight": NUMBER,
            "floor": NUMBER,
            "window": COUNT,
            "confidence": NUMBER,
            "allowance": NUMBER,
        },
        lambda: {
            "hypotheses": hypotheses(),
            "fallback": small.law(),
            "transition": [[0.9, 0.1], [0.0, 1.0]],
            "rate_weight": 1.0,
            "floor": 1e-6,
            "window": 20,
            "confidence": 0.999,
            "allowance": 10.0,
        },
        told=(*ABOUT, "transition"),
        public="multiple_model",
    ),
    Door(
        "MultipleModel.predict",
        lambda **given: several().predict(**given),
        {"observation": MATRIX, "state": maybe(MATRIX)},
        lambda: {"observation": np.array([[0.1, -0.2]]), "state": np.zeros((1, several().order))},
        told=("state",),
        check=finite,
        public="MultipleModel",
    ),
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
    Door(
        "stationary_cost",
        baselines.stationary_cost,
        {"plant": EITHER_PLANT, "controller": LINEAR},
        lambda: {"plant": small.plant(), "controller": small.law()},
        public="stationary_cost",
    ),
    Door(
        "closed_loop_poles",
        baselines.closed_loop_poles,
        {"plant": PLANT, "controller": LINEAR},
        lambda: {"plant": small.plant(), "controller": small.law()},
        public="closed_loop_poles",
    ),
    Door(
        "h_infinity_norm",
        baselines.h_infinity_norm,
        {"plant": PLANT, "controller": LINEAR},
        lambda: {"plant": small.plant(), "controller": small.law()},
        public="h_infinity_norm",
    ),
    Door(
        "stability_margins",
        baselines.stability_margins,
        {"plant": PLANT, "controller": LINEAR, "at": TEXT},
        lambda: {"plant": small.plant(), "controller": small.law(), "at": "input"},
        public="stability_margins",
    ),
    Door(
        "small_gain",
        baselines.small_gain,
        {"plant": PLANT, "controller": LINEAR, "others": PLANTS},
        lambda: {"plant": small.plant(), "controller": small.law(), "others": [small.plant()]},
        told=("others",),
        public="small_gain",
    ),
    Door(
        "evaluate",
        evaluated,
        {
            "controller": CONTROLLER,
            "env": ANY_ENV,
            "seeds": COUNTS,
            "reference": maybe(instance(baselines.Episodes)),
            "confidence": NUMBER,
        },
        lambda: {
            "controller": small.law(),
            "env": small.envs(),
            "seeds": [1, 2],
            "reference": None,
            "confidence": 0.9,
        },
        told=("action", "function"),
        public="evaluate",
    ),
    Door(
        "roll_out",
        baselines.roll_out,
        {"controller": CONTROLLER, "env": ANY_ENV, "seeds": COUNTS},
        lambda: {"controller": small.law(), "env": small.envs(), "seeds": [1, 2]},
        told=("action", "function"),
        public="roll_out",
    ),
    Door(
        "PlacementProblem.of",
        placement.PlacementProblem.of,
        {"config": instance(BladeConfig), "side": TEXT, "count": maybe(COUNT), "bounds": maybe(NUMBERS)},
        lambda: {"config": small.config(), "side": "actuators", "count": 2, "bounds": [0.0, 1.0]},
        told=("patches", "actuators", "sensors"),
        plain=False,
    ),
    Door(
        "place",
        lambda **given: placement.place(**given).positions,
        {
            "problem": instance(placement.PlacementProblem),
            "method": TEXT,
            "seed": COUNT,
            "start": maybe(NUMBERS),
        },
        lambda: {"problem": problem(), "method": "sqp", "seed": 0, "start": [0.1, 0.6]},
        told=("positions", "actuators"),
    ),
    Door(
        "reach",
        placement.reach,
        {"problem": instance(placement.PlacementProblem), "positions": NUMBERS},
        lambda: {"problem": problem(), "positions": [0.1, 0.6]},
        told=("actuators",),
    ),
    Door(
        "check_reach",
        placement.check_reach,
        {"problem": instance(placement.PlacementProblem), "positions": NUMBERS},
        lambda: {"problem": problem(), "positions": [0.1, 0.6]},
        told=("actuators",),
    ),
    Door(
        "optimal_positions",
        placement.optimal_positions,
        {"config": instance(BladeConfig), "side": choice("actuators", "sensors")},
        lambda: {"config": small.config(), "side": "actuators"},
    ),
    Door("optimal_layout", placement.optimal_layout, {"config": instance(BladeConfig)}, lambda: {"config": small.config()}),
]


@cache
def problem():
    return placement.PlacementProblem.of(small.config(), "actuators", 2)
