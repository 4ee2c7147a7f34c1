"""Doors of what is said of laws, computed or measured in episodes."""

from hypothesis import strategies as st

import baselines
from beamenv.plant.plant import Plant, SampledPlant
from tests.fuzz import small
from tests.fuzz.law_kinds import LINEAR, PLANT
from tests.fuzz.meaning import COUNTS, NOTHING, NUMBER, TEXT, Kind, instance, maybe
from tests.fuzz.oracle import Door
from tests.fuzz.wrapper_doors import cartpole

EITHER_PLANT = instance(Plant, SampledPlant)
PLANTS = Kind(
    "plants",
    lambda value: value if isinstance(value, (list, tuple)) and value and all(isinstance(one, Plant) for one in value) else NOTHING,
    st.sampled_from([[], [None], ()]),
)
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
]
