"""The spaces: 32 bits for other people's libraries, 64 for what is stepped."""

import warnings

import gymnasium
import numpy as np
import pytest

import beamenv

SHORT = {"duration": 0.01}  # 20 control intervals


IDS = [name for name in gymnasium.registry if name.startswith("beamenv/")]


@pytest.mark.parametrize("env_id", IDS)
def test_the_checker_of_stable_baselines_has_nothing_to_say(env_id):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    name = env_id.removeprefix("beamenv/RotatingBeam-").removesuffix("-v0")
    many = name in beamenv.SCENARIOS and beamenv.SCENARIOS[name].plants.bank > 2
    few = {"scenario": {"preset": name, "plants": {"bank": 2}}} if many else {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(gymnasium.make(env_id, **SHORT, **few).unwrapped)


def test_spaces_have_32_bits_and_what_is_stepped_64():
    short, long = (gymnasium.make(beamenv.ENV_ID, dtype=dtype).unwrapped for dtype in ("float32", np.float64))
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2)
    assert short.observation_space.dtype == short.action_space.dtype == batch.action_space.dtype == np.float32
    assert long.observation_space.dtype == long.action_space.dtype == np.float64
    for env in (short, long, batch):
        env.action_space.seed(0)
    first = [short.reset(seed=1)[0], long.reset(seed=1)[0], batch.reset(seed=[1, 2])[0]]
    actions = short.action_space.sample()
    given = [first, *([short.step(actions)[0], long.step(actions)[0], batch.step(np.tile(actions, (2, 1)))[0]] for _ in range(9))]
    for one, two, both in given:
        assert (one.dtype, two.dtype, both.dtype) == (np.float32, np.float64, np.float32)
        np.testing.assert_array_equal(one, two.astype(np.float32))
        np.testing.assert_array_equal(both[0], one)
        assert short.observation_space.contains(one) and long.observation_space.contains(two)
    np.testing.assert_array_equal(short.state, long.state)


def test_readings_at_full_scale_are_in_the_space_of_amperes():
    env = gymnasium.make(beamenv.ENV_ID, physical_units=True, scenario="overload").unwrapped
    env.reset(seed=0)
    readings = np.array([env.step(np.zeros(4))[0] for _ in range(200)])
    assert (np.abs(readings) == env.observation_space.high).any()
    assert all(env.observation_space.contains(reading) for reading in readings)


@pytest.mark.parametrize("dtype", ["float16", "int32", "double precision", 32, {}])
def test_other_numbers_are_refused(dtype):
    for make in (gymnasium.make, gymnasium.make_vec):
        with pytest.raises(ValueError, match="^dtype is .*, but must be 'float32' or 'float64'[.]$"):
            make(beamenv.ENV_ID, dtype=dtype)


def batch(**arguments):
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT, **arguments)
