"""Doors of the environments: making, resetting, stepping and wrapping them, plant files."""

import warnings
from functools import cache
from pathlib import Path

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from hypothesis import strategies as st

import beamenv
from beamenv.plant.files import load_plant, save_plant
from beamenv.plant.modal_plant import ModalPlant
from beamenv.scenarios.load_cases import CASES
from tests.fuzz import small
from tests.fuzz.blade_doors import BLADE, BLADE_PARTS, SCENARIO, SCENARIO_PARTS
from tests.fuzz.meaning import (
    ANYTHING,
    ARRAY,
    COUNT,
    COUNTS,
    FLAG,
    NOTHING,
    NUMBER,
    NUMBERS,
    PATH,
    RANGE,
    TEXT,
    Kind,
    choice,
    either,
    instance,
    maybe,
    table,
)
from tests.fuzz.oracle import Door, same, seen
from tests.fuzz.wrong import COPIABLE

NAMED_SCENARIO = Kind(
    "scenario",
    lambda value: str(value) if isinstance(value, str) else SCENARIO.means(value),
    st.sampled_from(["rotor", "no.toml", "x", ""]),
    SCENARIO_PARTS,
)
DESIGN = Kind(
    "design",
    lambda value: str(value) if isinstance(value, str) else BLADE.means(value),
    st.sampled_from(["x", "sound-blade"]),
    BLADE_PARTS,
)
DTYPE = Kind(
    "dtype",
    lambda value: value if isinstance(value, (str, type, np.dtype)) else NOTHING,
    st.sampled_from(["float32", "float64", np.float32, np.dtype("f8"), "float16", int, "x", np.dtype(">f4")]),
)
SINGLE = {
    "preset": TEXT,
    "speed": maybe(NUMBER),
    "blade": maybe(BLADE),
    "design": maybe(DESIGN),
    "scenario": maybe(NAMED_SCENARIO),
    "duration": NUMBER,
    "physical_units": FLAG,
    "dtype": DTYPE,
}
MODE = Kind(
    "mode",
    lambda value: value if isinstance(value, AutoresetMode) else str(value) if isinstance(value, str) else NOTHING,
    st.sampled_from([*AutoresetMode, "SameStep", "NextStep", "samestep", "Disabled"]),
)
BATCH = {
    "num_envs": COUNT,
    **SINGLE,
    "autoreset_mode": MODE,
    "max_episode_steps": maybe(COUNT),
}
RENDERED = {**SINGLE, "render_mode": maybe(TEXT)}
SINGLE_WORDS = ("speed", "section", "file", "duration", "blade", "beam", "preset", "design", "inlay", "plant", "layup")


def arguments():
    return {
        "preset": "thesis",
        "speed": None,
        "blade": dict(small.BLADE),
        "design": None,
        "scenario": {},
        "duration": small.DURATION,
        "physical_units": False,
        "dtype": "float64",
    }


def lived(env, seed=3):
    """What an environment is and does: its task, and two steps."""
    task = env.unwrapped.task
    observation, info = env.reset(seed=seed)
    assert env.observation_space.contains(observation) or not isinstance(env, gym.Env), "observation outside its space"
    steps = [env.step(np.zeros(env.action_space.shape)) for _ in range(2)]
    for each in (observation, *(step[0] for step in steps)):
        assert np.isfinite(each).all(), "observation is not finite"
    env.close()
    return {
        "blade": task.config,
        "design": task.design_config,
        "scenario": task.scenario,
        "steps": task.steps,
        "physical_units": task.physical_units,
        "did": (observation, info, steps),
        "spaces": (env.observation_space.shape, env.action_space.low, env.action_space.high),
    }


def made(make):
    """A way of making environments that tells what became of the arguments."""

    def call(**given):
        env = make(**given)
        found = lived(env)
        if "duration" in given and (duration := NUMBER.means(given["duration"])) is not NOTHING:
            assert found["steps"] == round(duration / found["blade"].control_interval), "another duration"
        if given.get("speed") is not None and (speed := NUMBER.means(given["speed"])) is not NOTHING:
            assert found["blade"].speed == speed, "another speed"
        return {**found, "num_envs": getattr(env, "num_envs", None)}

    return call


def read(found):
    """What is looked at beside the arguments; the name of a scenario and of a design stand for what is in them."""
    return {name: found[name] for name in ("blade", "physical_units", "num_envs")}


@cache
def twin():
    made = gym.make(beamenv.ENV_ID, blade=small.BLADE, duration=small.DURATION)
    made.reset(seed=1)
    return made


@cache
def twins():
    made = gym.make_vec(beamenv.ENV_ID, num_envs=2, blade=small.BLADE, duration=small.DURATION)
    made.reset(seed=1)
    return made


def in_episode(env, other, seed, do):
    """In the middle of an episode: what is refused leaves it going on as its twin's does."""
    action = np.full(env.action_space.shape, 0.3)
    for each in (env, other):
        each.reset(seed=seed)
        each.step(action)
    try:
        return do(env), env.unwrapped.state.copy(), env.step(action)
    except (ValueError, TypeError, AttributeError, KeyError, IndexError, OverflowError, gym.error.Error, RuntimeError, Warning):
        if not same(seen(env.step(action)), seen(other.step(action))):
            raise AssertionError("a refusal changed the episode") from None
        if env.unwrapped.np_random_seed != other.unwrapped.np_random_seed:
            raise AssertionError("a refusal changed the seed") from None
        raise


LOAD = table(
    {
        "case": choice(*CASES),
        **dict.fromkeys(("magnitude", "direction_deg", "onset", "duration", "frequency_ratio", "phase_deg"), RANGE),
    }
)
OPTIONS = maybe(table({"load": LOAD, "initial_state": ARRAY}))
SEEDS = Kind(
    "seeds",
    lambda value: COUNT.means(value) if COUNT.means(value) is not NOTHING else COUNTS.means(value),
    st.one_of(COUNTS.near, COUNT.near),
)
MASK = Kind(
    "mask",
    lambda value: value if value is None or (isinstance(value, np.ndarray) and value.dtype == bool) else NOTHING,
    st.just(np.array([True, False])),
)
BATCH_OPTIONS = maybe(table({"load": LOAD, "initial_state": ARRAY, "elapsed": either(COUNT, COUNTS), "reset_mask": MASK}))


def new_env():
    return gym.make(beamenv.ENV_ID, blade=small.BLADE, duration=small.DURATION)


def new_envs():
    return gym.make_vec(beamenv.ENV_ID, num_envs=2, blade=small.BLADE, duration=small.DURATION)


def wrapper(cls, vector=False):
    """Around an environment of its own where the example gives none; what is refused leaves it as it was."""

    def call(env=None, **given):
        own = env is OWN
        inner = (new_envs() if vector else new_env()) if own else env
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


def saved(plant, path):
    save_plant(plant, path)
    again = load_plant(path)
    Path(path).unlink()
    return again


DOORS = [
    Door(
        "gym.make",
        made(lambda **given: gym.make(beamenv.ENV_ID, disable_env_checker=True, **given)),
        SINGLE,
        arguments,
        read,
        SINGLE_WORDS,
        COPIABLE,
    ),
    Door(
        "gym.make scenario",
        made(lambda **given: gym.make("beamenv/RotatingBeam-delay-v0", disable_env_checker=True, **given)),
        {"scenario": maybe(NAMED_SCENARIO), "duration": NUMBER},
        lambda: {"blade": dict(small.BLADE), "scenario": {"preset": "white"}, "duration": small.DURATION},
        read,
        ("path", "file"),
        COPIABLE,
    ),
    Door(
        "gym.make_vec",
        made(lambda **given: gym.make_vec(beamenv.ENV_ID, **given)),
        BATCH,
        lambda: {"num_envs": 2, **arguments(), "autoreset_mode": "SameStep", "max_episode_steps": 3},
        read,
        SINGLE_WORDS,
        COPIABLE,
    ),
    Door(
        "RotatingBeamEnv",
        made(lambda **given: beamenv.RotatingBeamEnv(**given)),
        RENDERED,
        lambda: {**arguments(), "render_mode": None},
        read,
        SINGLE_WORDS,
        public="RotatingBeamEnv",
    ),
    Door(
        "RotatingBeamVectorEnv",
        made(lambda **given: beamenv.RotatingBeamVectorEnv(**given)),
        {**BATCH, "render_mode": maybe(TEXT), "render_index": maybe(SEEDS)},
        lambda: {
            "num_envs": 2,
            **arguments(),
            "autoreset_mode": "NextStep",
            "max_episode_steps": None,
            "render_mode": None,
            "render_index": 0,
        },
        read,
        SINGLE_WORDS,
        public="RotatingBeamVectorEnv",
    ),
    Door(
        "reset",
        lambda **given: in_episode(small.env(), twin(), 5, lambda env: env.reset(**given)),
        {"seed": maybe(COUNT), "options": OPTIONS},
        lambda: {"seed": 3, "options": {"load": {"case": "step", "magnitude": 20.0}}},
    ),
    Door(
        "step",
        lambda action: in_episode(small.env(), twin(), 6, lambda env: env.step(action)),
        {"action": ARRAY},
        lambda: {"action": np.array([0.1, -0.2])},
    ),
    Door(
        "batch reset",
        lambda **given: in_episode(small.envs(), twins(), 5, lambda env: env.reset(**given)),
        {"seed": maybe(SEEDS), "options": BATCH_OPTIONS},
        lambda: {"seed": [3, 4], "options": {"load": {"case": "step"}}},
        told=("seed",),
    ),
    Door(
        "batch step",
        lambda action: in_episode(small.envs(), twins(), 6, lambda env: env.step(action)),
        {"action": ARRAY},
        lambda: {"action": np.array([[0.1, -0.2], [0.3, 2.0]])},
    ),
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
        wrapper(beamenv.VectorSensorHistory, True),
        {"env": VECTOR_ENV, "length": COUNT},
        lambda: {"env": OWN, "length": 2},
        public="VectorSensorHistory",
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
        wrapper(beamenv.VectorPlacementWrapper, True),
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
    Door(
        "BladeVecEnv",
        lambda **given: vec(**given),
        {"num_envs": COUNT, "seed": maybe(COUNT), **SINGLE},
        lambda: {"num_envs": 2, "seed": 3, **arguments()},
        None,
        SINGLE_WORDS,
        COPIABLE,
        public="BladeVecEnv",
    ),
    Door(
        "load_plant", load_plant, {"source": PATH}, lambda: {"source": "solid-blade"}, told=("plant", "file"), public="load_plant"
    ),
    Door(
        "save_plant",
        saved,
        {"plant": instance(ModalPlant), "path": PATH},
        lambda: {"plant": load_plant("solid-blade").first(2), "path": "kept.npz"},
        told=("file",),
        public="save_plant",
    ),
]


def vec(**given):
    envs = beamenv.BladeVecEnv(**given)
    first = envs.reset()
    envs.close()
    return first, envs.num_envs
