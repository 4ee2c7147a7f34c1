"""The history an agent sees."""

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv, SensorHistory, VectorSensorHistory
from beamenv.envs.history import RollingHistory


def test_a_history_holds_readings_and_the_voltages_before_them_oldest_first():
    plain, env = RotatingBeamEnv(), SensorHistory(RotatingBeamEnv(), length=3)
    reading, _ = plain.reset(seed=0)
    window, _ = env.reset(seed=0)
    rows = [np.zeros(8), np.zeros(8), np.append(reading, np.zeros(4))]
    np.testing.assert_array_equal(window, np.concatenate(rows).astype(np.float32))
    for k in range(40):
        action = np.random.default_rng(k).uniform(-1.5, 1.5, size=4)
        reading, reward, *_ = plain.step(action)
        window, same_reward, *_ = env.step(action)
        rows = [*rows[1:], np.append(reading, np.clip(action, -1.0, 1.0))]
        np.testing.assert_allclose(window, np.concatenate(rows).astype(np.float32), atol=1e-7)
        assert reward == same_reward
        assert window in env.observation_space


def test_a_new_episode_forgets_the_last_one():
    env = SensorHistory(RotatingBeamEnv(), length=4)
    env.reset(seed=0)
    for _ in range(10):
        env.step(np.ones(4))
    window, _ = env.reset()
    assert not window[:-8].any()
    assert not window[-4:].any()
    assert window[-8:-4].any()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_histories_of_the_batch_are_those_of_single_environments(mode):
    arguments = {"duration": 0.02, "scenario": {"magnitude": [100.0, 8000.0], "onset": [0.0, 0.005]}}
    sync = gymnasium.make_vec(
        beamenv.ENV_ID,
        5,
        vectorization_mode="sync",
        vector_kwargs={"autoreset_mode": mode},
        wrappers=[lambda env: SensorHistory(env, length=6)],
        **arguments,
    )
    native = VectorSensorHistory(gymnasium.make_vec(beamenv.ENV_ID, 5, autoreset_mode=mode, **arguments), length=6)
    assert native.observation_space == sync.observation_space
    seeds = [3, 4, 5, 6, 7]
    np.testing.assert_allclose(native.reset(seed=seeds)[0], sync.reset(seed=seeds)[0], atol=1e-6)
    over = 0
    for k in range(130):
        actions = np.random.default_rng(k).uniform(-1.0, 1.0, size=(5, 4))
        expected, actual = sync.step(actions), native.step(actions)
        np.testing.assert_allclose(actual[0], expected[0], atol=1e-6)
        np.testing.assert_array_equal(actual[0] == 0.0, expected[0] == 0.0)
        assert ("final_obs" in actual[4]) == ("final_obs" in expected[4])
        for ours, theirs in zip(actual[4].get("final_obs", ()), expected[4].get("final_obs", ()), strict=True):
            assert (ours is None) == (theirs is None)
            if ours is not None:
                np.testing.assert_allclose(ours, theirs, atol=1e-6)
                over += 1
    assert over >= 5 * 3 if mode == "SameStep" else over == 0  # of at most 40 steps each


def test_a_window_is_a_copy():
    history = RollingHistory(2, 3, 1, 1)
    history.begin(np.ones((2, 1)))
    window = history.window()
    history.append(np.full((2, 1), 2.0), np.full((2, 1), 3.0))
    np.testing.assert_array_equal(window, [[0, 0, 0, 0, 1, 0]] * 2)
    np.testing.assert_array_equal(history.window(), [[0, 0, 1, 0, 2, 3]] * 2)
    np.testing.assert_array_equal(history.window(np.array([1])), [[0, 0, 1, 0, 2, 3]])


def test_a_history_of_one_is_the_last_reading_and_voltage():
    envs = VectorSensorHistory(RotatingBeamVectorEnv(2), length=1)
    envs.reset(seed=0)
    window, *_, info = envs.step(np.full((2, 4), 0.25))
    np.testing.assert_allclose(window[:, 4:], 0.25)
    np.testing.assert_allclose(info["volts"], 375.0)


@pytest.mark.parametrize("wrap", [beamenv.VectorSensorHistory, beamenv.VectorPlacementWrapper])
@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_a_wrapped_batch_tells_when_its_episodes_begin_anew(wrap, mode):
    envs = wrap(gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, autoreset_mode=mode))
    assert envs.autoreset_mode.value == mode
