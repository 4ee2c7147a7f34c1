"""Patches put elsewhere on the blades of a batch."""

import copy

import gymnasium
import numpy as np
import pytest

from beamenv import ENV_ID, VectorPlacementWrapper
from tests.placement.elsewhere import ELSEWHERE, batch, wrapped


def test_a_batch_takes_one_layout_for_each_blade():
    envs = batch(3, layouts=[ELSEWHERE, "uniform", {"actuators": ELSEWHERE["actuators"]}])
    singles = [wrapped(**ELSEWHERE), wrapped(), wrapped(actuators=ELSEWHERE["actuators"])]
    observations, info = envs.reset(seed=[4, 5, 6])
    assert info["layout"]["actuators"].shape == (3, 4)
    assert info["layout"]["sensors"][0] == pytest.approx(ELSEWHERE["sensors"])
    alone = [single.reset(seed=seed)[0] for single, seed in zip(singles, (4, 5, 6), strict=True)]
    assert observations == pytest.approx(np.stack(alone), abs=1e-12)
    for k in range(39):
        actions = np.random.default_rng(k).uniform(-1.0, 1.0, (3, 4))
        observations, rewards, *_ = envs.step(actions)
        steps = [single.step(action) for single, action in zip(singles, actions, strict=True)]
        assert observations == pytest.approx(np.stack([step[0] for step in steps]), abs=1e-12)
        assert rewards == pytest.approx([step[1] for step in steps], rel=1e-9)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_mixed_batch_goes_on_from_episode_to_episode(mode):
    envs = VectorPlacementWrapper(
        gymnasium.make_vec(ENV_ID, num_envs=5, duration=0.01, autoreset_mode=mode),
        actuators={"low": 0.0, "high": 0.6},
        bank=3,
    )
    _, info = envs.reset(seed=0)
    assert len(np.unique(info["layout"]["actuators"], axis=0)) == 3
    ends = 0
    for _ in range(50):
        observations, _, _, truncated, info = envs.step(np.zeros((5, 4)))
        assert np.all(np.isfinite(observations)) and info["layout"]["actuators"].shape == (5, 4)
        ends += truncated.sum()
    assert ends == 10


def test_a_batch_changes_its_layout_at_reset():
    envs = batch(2)
    envs.reset(seed=0, options={"layout": [ELSEWHERE, "uniform"]})
    with pytest.raises(ValueError, match="must be one layout, or a sequence of 2"):
        envs.reset(options={"layout": [ELSEWHERE]})
    _, info = envs.reset(options={"layout": ELSEWHERE})
    assert info["layout"]["sensors"] == pytest.approx(np.array([ELSEWHERE["sensors"]] * 2))


def test_layouts_of_one_batch_have_equally_many_patches():
    with pytest.raises(ValueError, match="those of one batch must have equally many"):
        batch(2, layouts=["uniform", {"actuators": [0.0]}])


def test_a_bank_is_a_positive_number():
    with pytest.raises(ValueError, match="bank is 0"):
        batch(2, bank=0)


@pytest.mark.parametrize("seed", [3, [3, 4, 5]])
def test_the_same_seeds_draw_the_same_layouts_for_a_batch(seed):
    def drawn():
        envs = batch(3, sensors={"low": 0.0, "high": 1.0})
        return [envs.reset(seed=seed)[1]["layout"]["sensors"], envs.reset()[1]["layout"]["sensors"]]

    first, second = drawn(), drawn()
    assert np.array_equal(first, second)
    assert not np.array_equal(first[0], first[1])


def test_a_copied_mixed_batch_goes_on_from_where_it_was():
    envs = batch(3, layouts=[ELSEWHERE, "uniform", "uniform"])
    envs.reset(seed=1)
    envs.step(np.full((3, 4), 0.3))
    copied = copy.deepcopy(envs)
    for _ in range(5):
        here, there = envs.step(np.full((3, 4), -0.2)), copied.step(np.full((3, 4), -0.2))
        assert np.array_equal(here[0], there[0])


@pytest.mark.parametrize("seed", [-1, "a", 1.5, True, [1], [1, -2]])
def test_a_seed_that_is_refused_moves_no_patch_of_a_batch(seed):
    envs = VectorPlacementWrapper(gymnasium.make_vec(ENV_ID, num_envs=2))
    before, plant = envs.reset(seed=0)[1]["layout"]["actuators"], envs.unwrapped.plant
    with pytest.raises(ValueError, match="^seed is"):
        envs.reset(seed=seed, options={"layout": {"actuators": [0.2, 0.5, 0.9, 1.2]}})
    assert envs.unwrapped.plant is plant
    np.testing.assert_array_equal(envs.reset(seed=0)[1]["layout"]["actuators"], before)


def test_layouts_of_a_batch_are_one_for_each_blade_in_an_array_or_a_list():
    layouts = [{"actuators": [0.3, 0.9], "sensors": [0.4]}, {"actuators": [0.5, 1.1], "sensors": [0.6]}]
    envs = VectorPlacementWrapper(gymnasium.make_vec(ENV_ID, num_envs=2), layouts=np.array(layouts))
    np.testing.assert_array_equal(envs.reset(seed=0)[1]["layout"]["actuators"], [[0.3, 0.9], [0.5, 1.1]])
    for numbers in (np.zeros((2, 4)), np.zeros((10**6, 4))):
        with pytest.raises(ValueError, match="^layouts is array.{1,250}, but must be one layout, or a sequence of 2") as refused:
            VectorPlacementWrapper(gymnasium.make_vec(ENV_ID, num_envs=2), layouts=numbers)
        assert len(str(refused.value)) < 400
