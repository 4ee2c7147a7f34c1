"""Resets of some blades of a batch, and the seeds of each."""

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import beamenv
from beamenv import VectorPlacementWrapper

SHORT = {"duration": 0.01}  # 20 control intervals


def test_autoreset_disabled_begins_the_episodes_that_a_mask_names():
    count, ends = 3, [6, 9, 12]
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=count, autoreset_mode="Disabled", **SHORT)
    each = SyncVectorEnv([lambda: gymnasium.make(beamenv.ENV_ID, **SHORT)] * count, autoreset_mode=AutoresetMode.DISABLED)
    assert batch.autoreset_mode is batch.metadata["autoreset_mode"] is AutoresetMode.DISABLED
    for envs in (batch, each):
        envs.reset(seed=[5, 6, 7])
    rng = np.random.default_rng(0)
    for step in range(50):
        actions = rng.uniform(-1.0, 1.0, (count, 4)).astype(np.float32)
        one, two = batch.step(actions), each.step(actions)
        for mine, theirs in zip((one[0], *one[2:4]), (two[0], *two[2:4]), strict=True):
            np.testing.assert_array_equal(mine, theirs)
        np.testing.assert_allclose(one[1], two[1], rtol=1e-12)
        mask = one[2] | one[3]
        if step in ends:
            mask = mask | (np.arange(count) == ends.index(step))
        if mask.any():
            shown, info = batch.reset(options={"reset_mask": mask})
            expected, told = each.reset(options={"reset_mask": mask})
            np.testing.assert_array_equal(shown, expected)
            np.testing.assert_array_equal(info["_energy"], mask)
            np.testing.assert_allclose(info["energy"], told["energy"], rtol=1e-12)
            np.testing.assert_array_equal(info["static_strain"], told["static_strain"])
    assert mask.any() or step == 49


def test_an_ended_episode_is_not_stepped_without_a_reset():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, autoreset_mode=AutoresetMode.DISABLED, **SHORT)
    with pytest.raises(gymnasium.error.ResetNeeded, match="without a mask first"):
        envs.reset(options={"reset_mask": np.array([True, False])})
    envs.reset(seed=0, options={"elapsed": np.array([0, 15])})
    for _ in range(5):
        envs.step(np.zeros((2, 4)))
    state = envs.unwrapped.state
    with pytest.raises(gymnasium.error.ResetNeeded, match=r"Episodes of blades \[1\] have ended"):
        envs.step(np.zeros((2, 4)))
    np.testing.assert_array_equal(envs.unwrapped.state, state)
    envs.reset(options={"reset_mask": np.array([False, True])})
    assert not envs.step(np.zeros((2, 4)))[3].any()


@pytest.mark.parametrize("mask", [True, [True, False], np.array([0, 1]), np.array([False, False]), np.array([True]), "all", {}])
def test_a_mask_that_is_none_is_refused(mask):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match=r"^options\['reset_mask'\] is .*, but must be an array of 2 bools, one of them True[.]$"):
        envs.reset(options={"reset_mask": mask})


def test_a_masked_reset_takes_the_seeds_of_its_blades():
    envs, alone = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT), gymnasium.make(beamenv.ENV_ID, **SHORT)
    mask = np.array([False, True])
    envs.reset(seed=0)
    with pytest.raises(ValueError, match="^seed is 3, but must be None beside a reset_mask"):
        envs.reset(seed=3, options={"reset_mask": mask})
    envs.reset(seed=[1, 2])
    shown, _ = envs.reset(seed=[None, 9], options={"reset_mask": mask})
    np.testing.assert_array_equal(shown[1], alone.reset(seed=9)[0])
    assert envs.np_random_seed == (1, 9)


def test_none_among_seeds_goes_on_with_the_generator_of_its_blade():
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3)
    each = SyncVectorEnv([lambda: gymnasium.make(beamenv.ENV_ID)] * 3)
    for seed in ([4, 5, 6], [1, None, 3], None, [None, 8, None]):
        np.testing.assert_array_equal(batch.reset(seed=seed)[0], each.reset(seed=seed)[0])
        assert batch.np_random_seed == each.np_random_seed
        assert [one.bit_generator.state for one in batch.np_random] == [one.bit_generator.state for one in each.np_random]
    first = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3)
    first.reset(seed=[1, None, 3])
    assert first.np_random_seed[::2] == (1, 3)
    first.reset(seed=11)
    assert first.np_random_seed == 11


def test_a_generator_that_is_set_is_drawn_from():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2)
    expected = envs.reset(seed=21)[0]
    envs.reset(seed=[1, 2])
    envs.np_random = gymnasium.utils.seeding.np_random(21)[0]
    np.testing.assert_array_equal(envs.reset()[0], expected)


@pytest.mark.parametrize("seed", [-1, 1.5, "one", True, 2j, {}])
def test_a_bad_seed_is_told_in_one_sentence(seed):
    for env in (gymnasium.make(beamenv.ENV_ID).unwrapped, gymnasium.make_vec(beamenv.ENV_ID, num_envs=2)):
        env.reset(seed=1)
        before = env.state
        with pytest.raises(ValueError, match="^seed is .*, but must be"):
            env.reset(seed=seed)
        np.testing.assert_array_equal(env.state, before)


def test_placements_are_drawn_anew_where_blades_have_seeds_of_their_own_and_none_among_them():
    envs = VectorPlacementWrapper(batch(), actuators={"low": 0.0, "high": 1.3, "count": 2})
    one, two = (envs.reset(seed=[1, 2])[1]["layout"]["actuators"] for _ in range(2))
    np.testing.assert_array_equal(one, two)
    other = envs.reset(seed=[1, None])[1]["layout"]["actuators"]
    assert other.shape == (2, 2)
    envs.step(np.zeros((2, 2)))
    kept = envs.reset(options={"reset_mask": np.array([True, False])})[1]["layout"]["actuators"]
    np.testing.assert_array_equal(kept, other)
    with pytest.raises(ValueError, match=r"^options\['layout'\] is 'uniform', but must be left out beside a reset_mask"):
        envs.reset(options={"reset_mask": np.array([True, False]), "layout": "uniform"})
    envs.reset(options={"elapsed": 3})


def batch(**arguments):
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT, **arguments)
