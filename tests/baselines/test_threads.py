"""Threads that share a law, or have an environment each, do not feel each other."""

from concurrent.futures import ThreadPoolExecutor

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import (
    Hypothesis,
    PersistentLoad,
    adaptive_neural,
    clipped_lqg,
    inverse_hysteresis,
    lqg,
    lqr,
    mpc,
    multiple_model,
    positive_position_feedback,
    reference_lqg,
)

LAWS = {
    "lqg": lqg,
    "lqr": lqr,
    "reference": reference_lqg,
    "clipped": clipped_lqg,
    "ppf": positive_position_feedback,
    "mpc": mpc,
    "multiple model": lambda plant: multiple_model([Hypothesis(plant, delay=d) for d in (0, 1)], lqg(plant)),
    "inverse hysteresis": lambda plant: inverse_hysteresis(lqg(plant), 0.2),
    "adaptive neural": adaptive_neural,
    "mpc with delay": lambda plant: mpc(plant, delay=2),
    "mpc with load": lambda plant: mpc(plant, PersistentLoad()),
}


def driven(law, seed):
    """Actions of a law that remembers, on random readings beyond the drive's limits."""
    random, memory, actions = np.random.default_rng(seed), None, []
    for _ in range(40):
        action, memory = law.predict(random.normal(size=(8, law.instruments.measurement_scale.size)), memory)
        actions.append(action)
    return np.array(actions)


@pytest.mark.parametrize("name", LAWS)
def test_a_law_shared_by_threads_gives_each_its_own_voltages(small_plant, name):
    law = LAWS[name](small_plant())
    alone = [driven(law, seed) for seed in range(6)]
    with ThreadPoolExecutor(6) as threads:
        np.testing.assert_array_equal(list(threads.map(lambda seed: driven(law, seed), range(6))), alone)


def episode(seed):
    env = gym.make(beamenv.ENV_ID, blade={"modes": 3}, duration=0.02)
    random, (observation, _) = np.random.default_rng(seed), env.reset(seed=seed)
    actions = random.uniform(-1.0, 1.0, (40, 4)).astype(env.action_space.dtype)
    return np.array([observation, *(env.step(action)[0] for action in actions)])


def test_environments_of_one_blade_in_several_threads_are_as_one_after_the_other():
    alone = [episode(seed) for seed in range(4)]
    with ThreadPoolExecutor(4) as threads:
        np.testing.assert_array_equal(list(threads.map(episode, range(4))), alone)
