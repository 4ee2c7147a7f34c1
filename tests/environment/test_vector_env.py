"""The native batch beside Gymnasium's own vectorisation of the single environment."""

import copy
import pickle
from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import beamenv
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv
from beamenv.scenarios.scenario import scenario

BRITTLE = {"magnitude": [100.0, 8000.0], "onset": [0.0, 0.005], "harmonic_magnitude": [100.0, 8000.0]}
"""Loads that break about half of the blades, each at its own time: autoresets are staggered."""


def both(mode, num_envs=7, seed=50, **arguments):
    """Gymnasium's SyncVectorEnv and the native batch, reset with the same seeds; and what their resets returned."""
    arguments = {"duration": 0.03, **arguments}
    sync = gymnasium.make_vec(
        beamenv.ENV_ID, num_envs, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, **arguments
    )
    native = gymnasium.make_vec(beamenv.ENV_ID, num_envs, autoreset_mode=mode, **arguments)
    seeds = list(range(seed, seed + num_envs))
    return (sync, native), (sync.reset(seed=seeds), native.reset(seed=seeds))


def assert_same(expected, actual):
    """The same nested structure with the same numbers, states differing by round-off only."""
    assert type(expected) is type(actual)
    if isinstance(expected, dict):
        assert expected.keys() == actual.keys()
        for key in expected:
            assert_same(expected[key], actual[key])
    elif isinstance(expected, tuple):
        for each, other in zip(expected, actual, strict=True):
            assert_same(each, other)
    elif isinstance(expected, np.ndarray) and expected.dtype == object:
        assert [each is None for each in expected] == [each is None for each in actual]
        for each, other in zip(expected, actual, strict=True):
            if isinstance(each, str):
                assert each == other
            elif each is not None:
                np.testing.assert_allclose(other, each, rtol=0, atol=1e-9)
    elif isinstance(expected, np.ndarray) and expected.dtype == bool:
        np.testing.assert_array_equal(actual, expected)
    else:
        assert actual.shape == expected.shape
        scale = max(1.0, np.abs(expected).max(initial=0.0))
        np.testing.assert_allclose(actual, expected, rtol=1e-9, atol=1e-12 * scale)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize("scenario", ["nominal", BRITTLE])
def test_the_batch_is_what_gymnasium_makes_of_single_environments(mode, scenario):
    (sync, native), (expected, actual) = both(mode, scenario=scenario)
    assert_same(expected, actual)
    ended = set()
    for k in range(200):
        actions = np.random.default_rng(k).uniform(-1.2, 1.2, size=(7, 4))
        expected, actual = sync.step(actions), native.step(actions)
        assert_same(expected, actual)
        ended.update([k] if (actual[2] | actual[3]).any() else [])
    assert len(ended) > (10 if scenario is BRITTLE else 2)


def test_the_next_step_mode_returns_the_first_observation_one_step_later():
    (_, envs), _ = both("NextStep", num_envs=3)
    for _ in range(59):
        *_, truncated, _ = envs.step(np.ones((3, 4)))
        assert not truncated.any()
    _, reward, _, truncated, info = envs.step(np.ones((3, 4)))
    assert truncated.all()
    assert reward.all()
    assert info["volts"].all()
    _, reward, terminated, truncated, info = envs.step(np.ones((3, 4)))
    assert not (terminated | truncated).any()
    assert not reward.any()
    assert not info["volts"].any()


def test_the_same_step_mode_returns_both_observations():
    (_, envs), _ = both("SameStep", num_envs=3)
    for _ in range(59):
        *_, info = envs.step(np.ones((3, 4)))
        assert "final_obs" not in info
    observation, reward, _, truncated, info = envs.step(np.ones((3, 4)))
    assert truncated.all()
    assert reward.all()
    assert not info["volts"].any()
    np.testing.assert_allclose(info["final_info"]["volts"], 1500.0)
    assert info["_final_obs"].all()
    assert not np.array_equal(np.stack(info["final_obs"]), observation)


@pytest.mark.parametrize("num_envs", [1, 2, 300, 521, 768])
def test_a_blade_moves_alike_in_batches_of_any_size(num_envs):
    envs = RotatingBeamVectorEnv(num_envs)
    first, _ = envs.reset(seed=list(range(num_envs)))
    rng = np.random.default_rng(0)
    rows = sorted({0, num_envs // 2, num_envs - 1})
    singles = [RotatingBeamEnv() for _ in rows]
    for row, env in zip(rows, singles, strict=True):
        np.testing.assert_allclose(env.reset(seed=row)[0], first[row], atol=1e-12)
    for _ in range(70):
        actions = rng.uniform(-1.0, 1.0, size=(num_envs, 4))
        observations, rewards, *_ = envs.step(actions)
        for row, env in zip(rows, singles, strict=True):
            observation, reward, *_ = env.step(actions[row])
            np.testing.assert_allclose(observations[row], observation, atol=1e-11)
            assert rewards[row] == pytest.approx(reward, rel=1e-9)


def returns(envs, seed, steps):
    envs.reset(seed=seed)
    return sum(envs.step(np.zeros((envs.num_envs, 4)))[1] for _ in range(steps))


def test_one_seed_for_the_batch_and_one_for_each_blade_are_statistically_equal():
    shared = returns(RotatingBeamVectorEnv(2000, duration=0.06), 0, 119)
    seeded = returns(RotatingBeamVectorEnv(2000, duration=0.06), list(range(2000)), 119)
    error = np.hypot(shared.std(), seeded.std()) / np.sqrt(2000)
    assert abs(shared.mean() - seeded.mean()) < 4.0 * error
    assert 0.8 < shared.std() / seeded.std() < 1.25


@pytest.mark.parametrize("seed", [3, [5, 6, 7, 8]])
def test_a_seed_gives_identical_bits_and_no_seed_goes_on(seed):
    def episodes():
        envs = RotatingBeamVectorEnv(4, duration=0.02)
        found = [envs.reset(seed=seed)[0]]
        found += [envs.step(np.full((4, 4), 0.3))[0] for _ in range(100)]
        found += [envs.reset()[0]]
        return np.stack(found)

    first, second = episodes(), episodes()
    assert np.array_equal(first, second)
    assert not np.array_equal(first[0], first[-1])


def test_the_blades_of_a_batch_differ():
    observation, _ = RotatingBeamVectorEnv(5).reset(seed=0)
    assert len(np.unique(observation[:, 0])) == 5


def test_a_reset_may_fix_load_and_initial_state():
    envs = RotatingBeamVectorEnv(3, scenario="quiet", duration=0.01, autoreset_mode="SameStep")
    states = np.random.default_rng(0).normal(size=(3, len(envs.plant.A))) * 1e-3
    envs.reset(options={"initial_state": states, "load": {"case": "none"}})
    np.testing.assert_allclose(envs.state, states, rtol=1e-12, atol=1e-17)
    for _ in range(20):
        envs.step(np.zeros((3, 4)))
    assert not envs.state.any()  # the next episode is the scenario's again


def test_a_batch_may_be_limited_in_steps():
    envs = gymnasium.make_vec(beamenv.ENV_ID, 2, max_episode_steps=4)
    envs.reset(seed=0)
    assert [envs.step(np.zeros((2, 4)))[3].tolist() for _ in range(4)] == [[False] * 2] * 3 + [[True] * 2]


def test_returned_arrays_are_the_callers_own():
    for mode in ("NextStep", "SameStep"):
        clean, spoilt = (RotatingBeamVectorEnv(3, duration=0.003, autoreset_mode=mode) for _ in range(2))
        clean.reset(seed=1)
        observation, info = spoilt.reset(seed=1)
        for _ in range(20):
            for array in (observation, *info.values()):
                if isinstance(array, np.ndarray) and array.dtype == np.float64:
                    array[:] = np.nan
            actions = np.full((3, 4), 0.4)
            expected = clean.step(actions)
            observation, reward, terminated, truncated, info = spoilt.step(actions)
            assert_same(expected, (observation, reward, terminated, truncated, info))
            for array in (reward, terminated, truncated):
                array[:] = 1
            assert np.array_equal(actions, np.full((3, 4), 0.4))


def test_spaces_and_metadata_are_those_of_a_vector_environment():
    envs = gymnasium.make_vec(beamenv.ENV_ID, 5)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    assert envs.single_observation_space == RotatingBeamEnv().observation_space
    observation, _ = envs.reset(seed=0)
    assert observation in envs.observation_space
    observation, reward, terminated, truncated, _ = envs.step(envs.action_space.sample())
    assert observation in envs.observation_space
    assert (reward.dtype, terminated.dtype, truncated.dtype) == (np.float64, np.bool_, np.bool_)


def test_a_closed_batch_says_that_it_must_be_reset():
    envs = gymnasium.make_vec(beamenv.ENV_ID, 2)
    envs.reset(seed=0)
    envs.close()
    envs.close()
    assert envs.closed
    with pytest.raises(gymnasium.error.ResetNeeded):
        envs.step(np.zeros((2, 4)))


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda envs: pickle.loads(pickle.dumps(envs))])
@pytest.mark.parametrize(
    ("make", "seed"), [(RotatingBeamEnv, 1), (lambda: RotatingBeamVectorEnv(6), 1), (lambda: RotatingBeamVectorEnv(2), [1, 2])]
)
def test_a_copy_goes_its_own_way_from_where_the_original_was(duplicate, make, seed):
    env, untouched = make(), make()
    for each in (env, untouched):
        each.reset(seed=seed)
        each.step(np.full(each.action_space.shape, 0.5))
    twin = duplicate(env)
    for _ in range(70):
        action = np.full(env.action_space.shape, 0.3)
        expected = untouched.step(action)
        assert np.array_equal(twin.step(action)[0], expected[0])
        assert np.array_equal(twin.state, untouched.state)
    assert np.array_equal(duplicate(untouched).state, twin.state)
    assert not np.array_equal(env.state, twin.state)


@pytest.mark.parametrize("name", ["off-model", "drift"])
def test_blades_that_share_a_plant_move_as_few_of_them_do(name):
    """Those of one plant are multiplied together where many share it, also once some have begun anew: to rounding as one by one."""
    of = scenario(name)
    of = replace(of, plants=replace(of.plants, bank=8))
    several, few, others = (gymnasium.make_vec(beamenv.ENV_ID, num_envs=n, scenario=of, dtype="float64") for n in (64, 4, 4))
    seeds, later, random = [*range(4)], [*range(10, 14)], np.random.default_rng(5)
    several.reset(seed=16 * seeds)
    few.reset(seed=seeds)
    for k in range(60):
        actions = random.uniform(-1.0, 1.0, (4, 4))
        if k == 20:
            several.reset(seed=8 * seeds + 8 * later, options={"reset_mask": np.arange(64) >= 32})
            others.reset(seed=later)
        moved, own = several.step(np.tile(actions, (16, 1)))[:2], few.step(actions)[:2]
        anew = own if k < 20 else others.step(actions)[:2]
        for all_of_them, first, second in zip(moved, own, anew, strict=True):
            parts = np.array(np.split(all_of_them, 16))
            np.testing.assert_allclose(parts[:8], np.broadcast_to(first, parts[:8].shape), rtol=1e-9, atol=1e-12)
            np.testing.assert_allclose(parts[8:], np.broadcast_to(second, parts[8:].shape), rtol=1e-9, atol=1e-12)
    plants = several.unwrapped._blades.plants
    assert len(plants._shared.plants) == len(set(plants.index.tolist())) > 1
