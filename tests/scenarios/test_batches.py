"""Every scenario in a batch, alone, and copied in the middle of an episode."""

import copy
import pickle
from functools import partial

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv
from beamenv.scenarios.named import NAMES, SOLIDS, UNSEEN
from beamenv.scenarios.scenario import SCENARIOS

SEEDS = [3, 4, 5, 6, 7]

EACH = [pytest.param(name, marks=pytest.mark.slow if name in set(UNSEEN) - set(SOLIDS) else ()) for name in NAMES]
"""What is combined from others takes longer than it tells."""
DRAWN = [name for name in NAMES if SCENARIOS[name].plants.varies]
SMALL = {
    **{name: {"preset": name, "plants": {"bank": 4}} for name in DRAWN},
    "gust-speed": {"plants": {"speed_wander": 0.05, "wander_frequency": 20.0, "bank": 8}},
    "drift": {"plants": {"mass_drift": [1.0, 1.15], "modulus_drift": [0.8, 1.0], "drift_duration": [0.01, 0.02], "bank": 5}},
    "mid-failure": {"preset": "mid-failure", "failures": {"onset": [0.0, 0.02]}},
    "spin-up": {"preset": "spin-up", "plants": {"spin_up": [199.9, 200.1]}},  # in 20 ms more would break the blade
}


def same(expected, actual):
    if isinstance(expected, dict):
        assert expected.keys() == actual.keys()
        for key in expected:
            same(expected[key], actual[key])
    elif isinstance(expected, tuple):
        for each, other in zip(expected, actual, strict=True):
            same(each, other)
    elif isinstance(expected, str):
        assert expected == actual
    elif expected.dtype == object:
        for each, other in zip(expected, actual, strict=True):
            assert (each is None) == (other is None)
            if each is not None:
                same(each, other)
    else:
        np.testing.assert_allclose(actual, expected, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize("name", EACH)
def test_a_batch_is_its_blades_alone_through_several_episodes(name, mode):
    """Plant, faults, loads, noise and lost readings are the same for the same seed, bit by bit of what is drawn."""
    arguments = {"scenario": SMALL.get(name, name), "duration": 0.02}
    sync = gymnasium.make_vec(beamenv.ENV_ID, 5, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, **arguments)
    native = gymnasium.make_vec(beamenv.ENV_ID, 5, autoreset_mode=mode, **arguments)
    same(sync.reset(seed=SEEDS), native.reset(seed=SEEDS))
    for k in range(130):
        actions = np.random.default_rng(k).uniform(-1.2, 1.2, size=(5, 4))
        same(sync.step(actions), native.step(actions))
        speeds = [env.unwrapped.rotor_speed for env in sync.envs]
        np.testing.assert_allclose(native.rotor_speed, speeds)
        np.testing.assert_allclose(native.design_state, [env.unwrapped.design_state for env in sync.envs], atol=1e-9)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize("name", EACH)
def test_blades_out_of_step_are_still_their_blades_alone(name, mode):
    """Staggered by options["elapsed"], the episodes end one after another; each blade is followed through its second one."""
    elapsed = np.array([0, 7, 19, 33, 38])
    native = RotatingBeamVectorEnv(5, scenario=SMALL.get(name, name), duration=0.02, autoreset_mode=mode)
    native.reset(seed=SEEDS, options={"elapsed": elapsed})
    singles = [RotatingBeamEnv(scenario=SMALL.get(name, name), duration=0.02) for _ in SEEDS]
    for env, seed in zip(singles, SEEDS, strict=True):
        env.reset(seed=seed)
    left = 40 - elapsed
    waiting = np.zeros(5, dtype=bool)
    for k in range(75):
        actions = np.random.default_rng(k).uniform(-1.0, 1.0, size=(5, 4))
        observations, rewards, _, truncated, _ = native.step(actions)
        for row, env in enumerate(singles):
            if waiting[row]:
                observation, reward, over = env.reset()[0], 0.0, False
                left[row], waiting[row] = 40, False
            else:
                observation, reward, *_ = env.step(actions[row])
                left[row] -= 1
                over = left[row] == 0
                if over and mode == "SameStep":
                    observation, left[row] = env.reset()[0], 40
                waiting[row] = over and mode == "NextStep"
            assert truncated[row] == over
            np.testing.assert_allclose(observations[row], observation, atol=1e-10)
            assert rewards[row] == pytest.approx(reward, rel=1e-8)


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
@pytest.mark.parametrize("kind", [RotatingBeamEnv, partial(RotatingBeamVectorEnv, 3)])
@pytest.mark.parametrize("name", EACH)
def test_a_copy_in_the_middle_of_an_episode_goes_on_alike(name, kind, duplicate):
    """But for the last bit: where its arrays begin in memory changes the order of sums."""
    env = kind(scenario=SMALL.get(name, name), duration=0.05)
    env.reset(seed=9)
    rng = np.random.default_rng(0)
    shape = env.action_space.shape
    for _ in range(30):
        env.step(rng.uniform(-1.0, 1.0, size=shape))
    twin = duplicate(env)
    for _ in range(90 if len(shape) > 1 else 60):
        action = rng.uniform(-1.0, 1.0, size=shape)
        ours, theirs = env.step(action), twin.step(action)
        np.testing.assert_allclose(theirs[0], ours[0], rtol=1e-11, atol=1e-13)
        np.testing.assert_allclose(theirs[1], ours[1], rtol=1e-11)
        for key, value in ours[4].items():
            if value.dtype == object:
                assert theirs[4][key].tolist() == value.tolist()
            else:
                np.testing.assert_allclose(theirs[4][key], value, rtol=1e-11, atol=1e-15)
    np.testing.assert_allclose(twin.state, env.state, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("name", EACH)
def test_the_reward_is_minus_the_cost_whatever_the_plant(name):
    """J adds up from steps whose cost is at least the actuators' effort, over the scale of the plant that all depart from."""
    env = RotatingBeamEnv(scenario=SMALL.get(name, name))
    plants = env.task.scenario.plants
    nominal = RotatingBeamEnv(scenario={"plants": {"modes": plants.modes, "truth": plants.truth}})
    env.reset(seed=1)
    nominal.reset(seed=1)
    _, reward, _, _, info = nominal.step(np.full(4, 0.1))
    scale = -info["cost_increment"] / reward
    for _ in range(20):
        _, reward, _, _, info = env.step(np.full(4, 0.1))
        assert reward == pytest.approx(-info["cost_increment"] / scale, rel=1e-9)
        assert info["cost_increment"] >= 0.99 * info["effort"]
