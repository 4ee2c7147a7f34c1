"""Doors of laws that are told more than the nominal plant: what may be drawn, what else may be the case, or the truth."""

from functools import cache

import numpy as np
from hypothesis import strategies as st

import baselines
from beamenv.blade.design import Design
from beamenv.knowledge import Prior, Truth
from tests.fuzz import small
from tests.fuzz.law_kinds import ABOUT, LINEAR, LOADS, PLANT, finite
from tests.fuzz.meaning import ARRAY, COUNT, FLAG, MATRIX, NOTHING, NUMBER, Kind, instance, maybe
from tests.fuzz.oracle import Door

HYPOTHESES = Kind(
    "hypotheses",
    lambda value: (
        value
        if isinstance(value, (list, tuple)) and value and all(isinstance(each, baselines.Hypothesis) for each in value)
        else NOTHING
    ),
    st.nothing(),
)


@cache
def hypotheses():
    return [baselines.Hypothesis(small.plant()), baselines.Hypothesis(small.plant(), sensor_gain=[1.0, 0.0])]


@cache
def several():
    return baselines.multiple_model(hypotheses(), small.law())


DOORS = [
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
        "spin_up_lqg",
        baselines.spin_up_lqg,
        {"prior": instance(Prior)},
        lambda: {"prior": small.env().unwrapped.task.prior},
        told=("prior",),
        plain=False,
        public="spin_up_lqg",
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
]
