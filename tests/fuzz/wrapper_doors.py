"""Doors of wrappers: what is shown of the past, where the patches are."""

import warnings
from functools import cache

import gymnasium as gym
import numpy as np
from hypothesis import strategies as st

import beamenv
from tests.fuzz import small
from tests.fuzz.env_doors import lived, lived_on_tensors
from tests.fuzz.episode_doors import LOAD, in_episode
from tests.fuzz.meaning import ANYTHING, ARRAY, COUNT, NOTHING, NUMBER, NUMBERS, Kind, maybe, table
from tests.fuzz.oracle import Door


def new_env():
    return gym.make(beamenv.ENV_ID, blade=small.BLADE, duration=small.DURATION)


def new_envs():
    return gym.make_vec(beamenv.ENV_ID, num_envs=2, blade=small.BLADE, duration=small.DURATION)


def new_tensors():
    return beamenv.torch_vec(2, "cpu", blade=small.BLADE, duration=small.DURATION)


def wrapper(cls, made=new_env, lived=lived):
    """Around an environment of its own where the example gives none; what is refused leaves it as it was."""

    def call(env=None, **given):
        own = env is OWN
        inner = made() if own else env
        task = inner.unwrapped.task if own else None
        try:
            return lived(cls(inner, **given))
        except Exception:
            if own and inner.unwrapped.task is not task:
                raise AssertionError("a refusal changed the environment") from None
            raise

    return call


OWN = type("Own", (), {"__repr__": lambda self: "an environment"})()
ENV = Kind(
    "env",
    lambda value: value if value is OWN else NOTHING,
    st.sampled_from(["cartpole", "history", "frames", "rescaled", "physical", "batch"]).map(lambda name: OTHERS[name]()),
)


@cache
def cartpole():
    return gym.make("CartPole-v1")


def rescaled():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Gymnasium's, about its own casting
        return gym.wrappers.RescaleObservation(new_env(), np.float64(-2.0), np.float64(3.0))


OTHERS = {
    "cartpole": cartpole,
    "history": cache(lambda: beamenv.SensorHistory(new_env(), 2)),
    "frames": cache(lambda: gym.wrappers.FrameStackObservation(new_env(), 2)),
    "rescaled": cache(rescaled),
    "physical": cache(lambda: gym.make(beamenv.ENV_ID, blade=small.BLADE, duration=small.DURATION, physical_units=True)),
    "batch": cache(new_envs),
}
ANY_UNITS = Kind("env", lambda value: value if value is OWN or value is OTHERS["physical"]() else NOTHING, ENV.near)
VECTOR_ENV = Kind(
    "envs", ENV.means, st.sampled_from(["cartpole", "single"]).map(lambda name: {"cartpole": cartpole, "single": new_env}[name]())
)
SIDE = Kind(
    "side",
    lambda value: (
        value
        if isinstance(value, str)
        else next((read for kind in (COUNT, NUMBERS, RANGES) if (read := kind.means(value)) is not NOTHING), NOTHING)
    ),
    st.one_of(
        NUMBERS.near, COUNT.near, st.sampled_from(["uniform", "optimal", "thesis-table-6.3", {"low": 0.1, "high": 1.0, "count": 2}])
    ),
)
RANGES = table({"low": NUMBER, "high": NUMBER, "count": COUNT})
LAYOUT = Kind(
    "layout",
    lambda value: value if isinstance(value, str) else table({"actuators": SIDE, "sensors": SIDE}).means(value),
    st.sampled_from(["uniform", "x"]),
    {"actuators": maybe(SIDE), "sensors": maybe(SIDE)},
)


def placed():
    """Two, for what is accepted stays."""
    return tuple(beamenv.PlacementWrapper(new_env()) for _ in range(2))


DOORS = [
    Door(
        "SensorHistory",
        wrapper(beamenv.SensorHistory),
        {"env": ENV, "length": COUNT},
        lambda: {"env": OWN, "length": 2},
        plain=True,
        public="SensorHistory",
    ),
    Door(
        "VectorSensorHistory",
        wrapper(beamenv.VectorSensorHistory, new_envs),
        {"env": VECTOR_ENV, "length": COUNT},
        lambda: {"env": OWN, "length": 2},
        public="VectorSensorHistory",
    ),
    Door(
        "TorchSensorHistory",
        wrapper(beamenv.TorchSensorHistory, new_tensors, lived_on_tensors),
        {"env": VECTOR_ENV, "length": COUNT},
        lambda: {"env": OWN, "length": 2},
        public="TorchSensorHistory",
    ),
    Door(
        "PlacementWrapper",
        wrapper(beamenv.PlacementWrapper),
        {"env": ANY_UNITS, "actuators": maybe(SIDE), "sensors": maybe(SIDE)},
        lambda: {"env": OWN, "actuators": [0.1, 0.6], "sensors": None},
        told=("layout", "span"),
        public="PlacementWrapper",
    ),
    Door(
        "VectorPlacementWrapper",
        wrapper(beamenv.VectorPlacementWrapper, new_envs),
        {"env": VECTOR_ENV, "actuators": maybe(SIDE), "sensors": maybe(SIDE), "layouts": ANYTHING, "bank": COUNT},
        lambda: {"env": OWN, "actuators": [0.1, 0.6], "sensors": None, "layouts": None, "bank": 2},
        told=("layout", "actuators"),
        public="VectorPlacementWrapper",
    ),
    Door(
        "PlacementWrapper.reset",
        lambda **given: in_episode(*placed(), 5, lambda env: env.reset(**given))[0],
        {"seed": maybe(COUNT), "options": maybe(table({"layout": LAYOUT, "load": LOAD, "initial_state": ARRAY}))},
        lambda: {"seed": 3, "options": {"layout": {"actuators": [0.1, 0.6]}}},
        told=("layout", "actuators", "sensors"),
    ),
]
