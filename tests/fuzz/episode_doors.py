"""Doors of episodes: resetting and stepping environments."""

from functools import cache

import gymnasium as gym
import numpy as np
from hypothesis import strategies as st

import beamenv
from beamenv.scenarios.load_cases import CASES
from tests.fuzz import small
from tests.fuzz.env_doors import SEEDS
from tests.fuzz.meaning import ARRAY, COUNT, COUNTS, NOTHING, RANGE, Kind, choice, either, maybe, table
from tests.fuzz.oracle import Door, same, seen


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
MASK = Kind(
    "mask",
    lambda value: value if value is None or (isinstance(value, np.ndarray) and value.dtype == bool) else NOTHING,
    st.just(np.array([True, False])),
)
BATCH_OPTIONS = maybe(table({"load": LOAD, "initial_state": ARRAY, "elapsed": either(COUNT, COUNTS), "reset_mask": MASK}))


DOORS = [
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
]
