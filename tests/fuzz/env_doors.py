"""Doors that make environments."""

import math
from collections.abc import Mapping
from functools import partial
from pathlib import PurePath

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from hypothesis import strategies as st

import beamenv
from beamenv.plant.plant import Plant
from beamenv.plant.spread import Spread
from tests.fuzz import small
from tests.fuzz.blade_doors import BLADE, BLADE_PARTS, SCENARIO, SCENARIO_PARTS
from tests.fuzz.meaning import COUNT, COUNTS, FLAG, NOTHING, NUMBER, TEXT, Kind, maybe
from tests.fuzz.oracle import Door
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
PLANT = Kind(
    "plant",
    lambda value: value if isinstance(value, (str, PurePath, Mapping, list, tuple, Plant)) else NOTHING,
    st.sampled_from(["x", "no.npz", "solid-blade", "", {}, {"A": 1.0}, [], [3], {"A": -1.0, "B": 1.0, "C": 1.0, "x": 1}]),
)
SPREAD = Kind(
    "spread",
    lambda value: value if isinstance(value, (Mapping, Spread)) else NOTHING,
    st.sampled_from([{}, {"frequency": 0.1}, {"frequency": -1.0}, {"frequency": True}, {"x": 1.0}, Spread(damping=0.2)]),
)
SINGLE = {
    "preset": TEXT,
    "speed": maybe(NUMBER),
    "blade": maybe(BLADE),
    "design": maybe(DESIGN),
    "scenario": maybe(NAMED_SCENARIO),
    "duration": maybe(NUMBER),
    "physical_units": FLAG,
    "dtype": DTYPE,
    "plant": maybe(PLANT),
    "spread": maybe(SPREAD),
}
DEVICE = Kind(
    "device",
    lambda value: str(value) if isinstance(value, str) else NOTHING,
    st.sampled_from(["cpu", "cpu:0", "cuda", "cuda:99", "mps", "gpu", "", "cuda:-1"]),
)
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
SEEDS = Kind(
    "seeds",
    lambda value: COUNT.means(value) if COUNT.means(value) is not NOTHING else COUNTS.means(value),
    st.one_of(COUNTS.near, COUNT.near),
)
MODEL = {"A": [[0.0, 300.0], [-300.0, -6.0]], "B": [0.0, 1.0], "C": [0.0, 1.0], "interval": 1e-3}
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
        "plant": None,
        "spread": None,
    }


def of_model():
    """Arguments of an environment with a model of one's own."""
    return {"plant": dict(MODEL), "spread": {"frequency": 0.1}, "scenario": {"plants": {"bank": 2}}, "duration": 0.02}


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


def of_tensors(name, **given):
    """What a batch of tensors is and does."""
    return lived_on_tensors(getattr(beamenv, name)(**given))


def lived_on_tensors(envs):
    observation, _ = envs.reset(seed=3)
    for _ in range(2):
        observation, *_ = envs.step(np.zeros(envs.action_space.shape))
        assert bool(observation.isfinite().all()), "observation is not finite"
    assert str(observation.dtype) == f"torch.{envs.observation_space.dtype}", "other numbers than the space's"
    blades, task = envs.unwrapped, envs.unwrapped.task
    return {
        "blade": task.config,
        "scenario": task.scenario,
        "physical_units": task.physical_units,
        "num_envs": envs.num_envs,
        "steps": blades.steps,
        "differentiable": blades.differentiable,
        "shown": observation.shape,
    }


def read(found):
    """What is looked at beside the arguments; the name of a scenario and of a design stand for what is in them."""
    return {name: found[name] for name in ("blade", "physical_units", "num_envs")}


def vec(**given):
    envs = beamenv.BladeVecEnv(**given)
    first = envs.reset()
    envs.close()
    return first, envs.num_envs


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
        "gym.make plant",
        made(lambda **given: gym.make(beamenv.ENV_ID, disable_env_checker=True, **given)),
        {name: SINGLE[name] for name in ("plant", "spread", "duration", "physical_units", "design")},
        lambda: {**of_model(), "physical_units": False, "design": None},
        None,
        ("the model", "A", "B", "C", "field", "file", "fields", "duration"),
        COPIABLE,
        plain=False,
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
        "BladeVecEnv",
        lambda **given: vec(**given),
        {"num_envs": COUNT, "seed": maybe(COUNT), **SINGLE},
        lambda: {"num_envs": 2, "seed": 3, **arguments()},
        None,
        SINGLE_WORDS,
        COPIABLE,
        public="BladeVecEnv",
    ),
]
NEVER_TRUE = Kind("flag", FLAG.means, st.sampled_from([False, np.False_, 1, 0, "no", math.nan]))
"""To compile a step takes seconds, and is tested for itself."""
DOORS += [
    Door(
        name,
        partial(of_tensors, name),
        {**BATCH, "device": maybe(DEVICE), "differentiable": FLAG, "graph": FLAG, "compiled": NEVER_TRUE},
        lambda: {
            "num_envs": 2,
            **arguments(),
            "autoreset_mode": "SameStep",
            "max_episode_steps": 3,
            "device": "cpu",
            "differentiable": False,
            "graph": False,
            "compiled": False,
        },
        lambda found: {**read(found), "differentiable": found["differentiable"]},
        (*SINGLE_WORDS, "graphs"),
        public=name,
    )
    for name in ("torch_vec", "TorchRotatingBeamVectorEnv")
]
