"""Several scenarios in one batch: each keeps its own blades, and all observations have one width."""

import numpy as np
import pytest

from beamenv.simulation.blades import reward_scale
from beamenv.task import resolve_task
from train.learning.sb3.ppo import PPOSettings
from train.learning.sb3.sb3 import training_envs
from train.learning.sb3.side_by_side import SideBySide
from train.learning.sb3.vec_env import REWARD_UNIT, TrainingVecEnv
from train.learning.training import uncontrolled_cost

SCENARIOS = ("nominal", "overload", "spillover")


def tasks():
    return [resolve_task(duration=0.01, scenario=name) for name in SCENARIOS]


def batch(index, count=2, **kwargs):
    return TrainingVecEnv(count, tasks()[index], index, history=3, shows_state=True, **kwargs)


def several():
    return SideBySide([batch(index) for index in range(3)])


def test_blades_are_divided_among_the_scenarios_and_none_is_left_out():
    envs = training_envs(tasks(), PPOSettings(blades=8, history=3, batch=64), 0)
    assert [each.num_envs for each in envs.batches] == [3, 3, 2]
    with pytest.raises(ValueError, match="blades = 2 must be at least one for each of the 3 scenarios"):
        training_envs(tasks(), PPOSettings(blades=2, history=3, batch=32), 0)


def test_windows_rewards_and_ends_are_those_of_the_batches():
    together, alone = several(), [batch(index) for index in range(3)]
    seen = together.seen
    rows = [each.reset() for each in alone]
    np.testing.assert_array_equal(together.reset()[:, :seen], np.concatenate([row[:, :seen] for row in rows]))
    over = 0
    for step in range(25):
        actions = np.sin(step + np.arange(24.0)).reshape(6, 4)
        observations, rewards, ends, infos = together.step(actions)
        parts = [each.step(part) for each, part in zip(alone, np.split(actions, 3), strict=True)]
        np.testing.assert_array_equal(observations[:, :seen], np.concatenate([part[0][:, :seen] for part in parts]))
        np.testing.assert_array_equal(rewards, np.concatenate([part[1] for part in parts]))
        np.testing.assert_array_equal(ends, np.concatenate([part[2] for part in parts]))
        assert [bool(info) for info in infos] == ends.tolist()
        for row in np.flatnonzero(ends):
            assert infos[row]["terminal_observation"].shape == together.observation_space.shape
            assert infos[row]["TimeLimit.truncated"] is True
        over += np.count_nonzero(ends)
    assert over >= 6  # every blade's episode ends at least once


def test_a_critic_is_told_which_scenario_a_blade_is_in():
    observations = several().reset()
    np.testing.assert_array_equal(observations[:, -3:], np.repeat(np.eye(3), 2, axis=0))


def test_a_mode_keeps_its_place_whatever_the_order_of_the_plant():
    """The solid has 11 modes, nominal's blade more: first displacements, then velocities, then electronics."""
    both = [resolve_task(duration=0.01, scenario=name) for name in ("nominal", "solid")]
    batches = [TrainingVecEnv(2, task, 0, history=3, shows_state=True) for task in both]
    envs, own = SideBySide(batches), TrainingVecEnv(2, both[1], 0, history=3, shows_state=True).reset()
    states = envs.reset()[2:, envs.seen : -2]
    modes, plant = 11, batches[0].blades.plant
    most = len(plant.natural_frequencies)
    assert most > modes and states.shape[1] == len(plant.A)
    np.testing.assert_array_equal(states[:, :modes], own[:, envs.seen : envs.seen + modes])
    np.testing.assert_array_equal(states[:, most : most + modes], own[:, envs.seen + modes : envs.seen + 2 * modes])
    np.testing.assert_array_equal(states[:, 2 * most :], own[:, envs.seen + 2 * modes :])
    assert not states[:, modes:most].any()
    assert not states[:, most + modes : 2 * most].any()


def test_rewards_are_in_units_of_no_control_s_cost():
    """Overload's loads are some 17 times nominal's, its costs hundreds of times; rewards are of one size."""
    task = tasks()[1]
    reference = uncontrolled_cost(task)
    plain, relative = batch(1), batch(1, reference=reference)
    plain.reset()
    relative.reset()
    rewards, scaled = (envs.step(np.zeros((2, 4)))[1] for envs in (plain, relative))
    np.testing.assert_allclose(scaled, rewards * reward_scale(task.plant) * task.steps / reference, rtol=1e-5)
    assert relative.relative_cost == pytest.approx(plain.last_cost * task.steps / reference)
    assert np.abs(scaled).max() < 10 * REWARD_UNIT
    assert np.isnan(plain.relative_cost)


def test_training_never_meets_a_plant_of_the_evaluation():
    task = resolve_task(duration=0.005, scenario={"plants": {"damping_ratio": (0.003, 0.02), "bank": 3}})
    envs = training_envs([task], PPOSettings(blades=4, history=3, batch=64), 0)
    decays = {float(np.trace(fused[: len(fused), : len(fused)])) for fused in envs.blades.task.bank.operators.fused}
    others = {float(np.trace(fused[: len(fused), : len(fused)])) for fused in task.bank.operators.fused}
    assert len(decays | others) == 6
