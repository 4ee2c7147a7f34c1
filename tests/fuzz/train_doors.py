"""Doors of training: settings, recipes, budgets, jobs, policies, the benchmark."""

import shutil
from dataclasses import replace
from functools import cache
from pathlib import Path

import gymnasium
import numpy as np
from gymnasium import Env
from hypothesis import strategies as st

import beamenv
from beamenv.plant.plant import Plant
from tests.fuzz import small
from tests.fuzz.env_doors import NAMED_SCENARIO, SINGLE, SINGLE_WORDS
from tests.fuzz.law_kinds import finite
from tests.fuzz.meaning import (
    ANYTHING,
    COUNT,
    FLAG,
    MATRIX,
    NOTHING,
    NUMBER,
    PATH,
    RANGE,
    TEXT,
    Kind,
    instance,
    maybe,
    of_fields,
    table,
)
from tests.fuzz.oracle import Door
from train.benchmark import benchmark
from train.controllers import controller
from train.controllers.ids import found
from train.controllers.named import named
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import load_policy
from train.controllers.shipped import find_shipped, shipped
from train.datasets import record
from train.learning.agents import AGENTS
from train.learning.recipe import _recipe, load_recipe, named_recipe
from train.learning.session import Budget
from train.tuning.space import _space

SETTINGS = {name: type(agent.settings()) for name, agent in AGENTS.items()}


@cache
def policy():
    first = shipped()[0]
    return load_policy(first.folder)


@cache
def history():
    generator = np.random.default_rng(0)
    weights = {
        "weight0": generator.normal(size=(5, 12)) * 0.1,
        "bias0": np.zeros(5),
        "weight1": generator.normal(size=(2, 5)) * 0.1,
        "bias1": np.zeros(2),
    }
    return HistoryPolicy("mine", weights, {"input_gain": 1.0, "held": 1}, -np.ones(2, np.float32), np.ones(2, np.float32))


@cache
def environment():
    return gymnasium.make(beamenv.ENV_ID, duration=0.02)


def settings_door(name, cls):
    return Door(f"{name} settings", lambda **given: cls(**given), of_fields(cls), dict, lambda made: made, ("settings",))


def recipe_table(name):
    recipe = named_recipe(name)
    return {**recipe.to_dict()}


def recipe_door(name):
    settings = of_fields(SETTINGS[named_recipe(name).agent])
    kinds = {"agent": TEXT, "title": TEXT, "updates": COUNT, "settings": table(settings)}
    return Door(
        f"recipe {name}",
        lambda **given: _recipe(given, "mine.toml"),
        kinds,
        lambda: recipe_table(name),
        lambda made: made,
        ("recipe",),
    )


def space_door(name):
    """What is tried of one setting, beside another that is as it ships."""
    recipe = named_recipe(name)

    def call(**given):
        return _space({"agent": recipe.agent, "settings": {"learning_rate": given}}, "mine.toml", recipe)

    kinds = {"between": maybe(RANGE), "times": maybe(RANGE), "choices": ANYTHING}
    valid = {"times": [0.5, 2.0]}
    return Door(f"space of {name}", call, kinds, lambda: dict(valid), lambda made: made.tried["learning_rate"], ("space",))


TEXTS = Kind(
    "texts",
    lambda value: (
        tuple(map(str, value))
        if isinstance(value, (list, tuple, np.ndarray)) and all(isinstance(each, (str, Path)) for each in value)
        else NOTHING
    ),
    st.sampled_from([["nominal"], ["delay", "x"], "delay", []]),
)


def benched(**given):
    return benchmark(**given).scenarios


def recorded(**given):
    before = set(Path.cwd().iterdir())
    try:
        return record(**given).total_episodes
    finally:
        for each in set(Path.cwd().iterdir()) - before:
            shutil.rmtree(each) if each.is_dir() else each.unlink()


DOORS = [
    *(
        settings_door(name, cls)
        for name, cls in {
            "gradient": SETTINGS["gradient"],
            "ppo": SETTINGS["ppo"],
            "sac": SETTINGS["sac"],
            "recurrent-ppo": SETTINGS["recurrent-ppo"],
        }.items()
    ),
    *(recipe_door(name) for name in ("gradient", "ppo", "residual", "sac")),
    *(space_door(name) for name in ("gradient", "sac")),
    Door(
        "Budget",
        lambda **given: Budget(**given),
        {"updates": NUMBER, "seconds": NUMBER},
        lambda: {"updates": 3.0, "seconds": 2.0},
        lambda made: made,
    ),
    Door("named_recipe", named_recipe, {"name": TEXT}, lambda: {"name": "gradient"}, told=("agent", "recipe")),
    Door("load_recipe", load_recipe, {"path": PATH}, lambda: {"path": "mine.toml"}, told=("file",)),
    Door("named", named, {"name": TEXT}, lambda: {"name": "lqg"}, told=("controller",)),
    Door(
        "controller",
        lambda **given: controller(**given),
        {"name": TEXT, "env": instance(Env), "trained_seed": maybe(COUNT)},
        lambda: {"name": "lqg", "env": environment(), "trained_seed": None},
        told=("controller",),
    ),
    Door(
        "found",
        lambda **given: found(**given),
        {"name": TEXT, "scenario": TEXT, "seed": maybe(COUNT)},
        lambda: {"name": "residual-generalist", "scenario": "nominal", "seed": 1},
        told=("controller", "trained_seed"),
    ),
    Door(
        "find_shipped",
        lambda **given: find_shipped(**given),
        {"agent": TEXT, "scenario": TEXT, "seed": maybe(COUNT)},
        lambda: {"agent": shipped()[0].agent, "scenario": shipped()[0].scenario, "seed": shipped()[0].seed},
    ),
    Door(
        "load_policy",
        load_policy,
        {"folder": PATH, "plant": maybe(instance(Plant))},
        lambda: {"folder": str(shipped()[0].folder), "plant": None},
        told=("agent",),
    ),
    Door(
        "Policy.predict",
        lambda **given: history().predict(**given),
        {"observation": MATRIX, "state": maybe(MATRIX), "episode_start": ANYTHING},
        lambda: {
            "observation": np.array([[0.1, -0.2]]),
            "state": np.zeros((1, history().memory_size)),
            "episode_start": np.array([True]),
        },
        check=finite,
    ),
    Door(
        "record",
        recorded,
        {
            "controller": ANYTHING,
            "scenario": maybe(NAMED_SCENARIO),
            "episodes": replace(COUNT, near=st.sampled_from([0, -1, 1.5, 1.0, True, "1"])),
            "seed": COUNT,
            "name": maybe(TEXT),
            "folder": PATH,
            "environment": maybe(table({k: v for k, v in SINGLE.items() if k not in ("scenario", "plant")})),
            "trained_seed": maybe(COUNT),
            "overwrite": FLAG,
        },
        lambda: {
            "controller": "none",
            "scenario": "nominal",
            "episodes": 1,
            "seed": 5,
            "name": "beamenv/mine-v0",
            "folder": "made",
            "environment": {"blade": dict(small.BLADE), "duration": 0.002},
            "trained_seed": None,
            "overwrite": False,
        },
        told=("controller", "dtype", *SINGLE_WORDS),
        plain=False,
    ),
    Door(
        "benchmark",
        benched,
        {
            "own": maybe(ANYTHING),
            "scenarios": maybe(TEXTS),
            "controllers": maybe(TEXTS),
            "seeds": COUNT,
            "runs": maybe(COUNT),
            "folder": maybe(PATH),
            "models": TEXTS,
            "trusted": FLAG,
            "jobs": replace(COUNT, near=st.sampled_from([0, -1, 1.5, 1.0, True, "1"])),
            "cluster": maybe(TEXT),
            "environment": maybe(table({k: v for k, v in SINGLE.items() if k != "scenario"})),
            "validation": FLAG,
        },
        lambda: {
            "own": None,
            "scenarios": ["nominal"],
            "controllers": ["none"],
            "seeds": 2,
            "runs": None,
            "folder": None,
            "models": [],
            "trusted": False,
            "jobs": 1,
            "cluster": None,
            "environment": {"blade": dict(small.BLADE), "duration": 0.002},
            "validation": False,
        },
        told=("controller", "model", *(word for word in SINGLE_WORDS if word != "duration")),
        plain=False,
    ),
]
