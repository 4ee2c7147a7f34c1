"""Blades that meet the same: chance is taken out of the comparison of what they try."""

from copy import deepcopy

import numpy as np
import pytest

from beamenv.task import resolve_task
from train.learning.sb3.fitted import Regression
from train.learning.sb3.ppo import PPOSettings, PPOTraining
from train.learning.sb3.twins import Twins, without_the_twin
from train.learning.sb3.typical import LOAD_UNIT
from train.learning.sb3.vec_env import TrainingVecEnv

SHORT = {"duration": 0.01}  # 20 control intervals
ESTIMATE = {"blades": 8, "sees": "estimate", "modes": 2, "actor": "linear", "critic": "quadratic", "twins": True}
ESTIMATE |= {"held": 2, "rollout": 8, "batch": 64}


@pytest.mark.parametrize("count", [6, 512])
def test_twins_under_the_same_voltages_move_alike_and_others_apart(count):
    envs = TrainingVecEnv(count, {**SHORT, "scenario": "failure"}, seed=2, shows_state=True, shows_loads=True, twins=True)
    observations, half = envs.reset(), count // 2
    actions = np.random.default_rng(0).uniform(-0.1, 0.1, (half, 4)).astype(np.float32)
    for _ in range(50):  # over ends and beginnings
        np.testing.assert_array_equal(observations[:half], observations[half:])
        assert len(np.unique(observations[:half], axis=0)) == half
        observations, rewards, _, _ = envs.step(np.vstack([actions, actions]))
    np.testing.assert_array_equal(rewards[:half], rewards[half:])


def test_an_odd_number_of_beginnings_draws_as_a_plain_generator_does():
    twins, plain = Twins(np.random.PCG64(3)), np.random.Generator(np.random.PCG64(3))
    np.testing.assert_array_equal(twins.random((3, 2)), plain.random((3, 2)))
    np.testing.assert_array_equal(twins.standard_normal((1, 2)), plain.standard_normal((1, 2)))


def test_what_chance_gives_both_twins_is_no_advantage_of_either():
    generator = np.random.default_rng(0)
    chance, own = generator.normal(size=(5, 3)), generator.normal(size=(5, 6))
    loads = np.tile(generator.normal(size=(5, 3, 2)), (1, 2, 1))
    loads[:, 2] += 1.0  # the third has lost its twin
    told = without_the_twin(np.tile(chance, (1, 2)) + own, loads)
    np.testing.assert_allclose(told[:, [0, 1]], own[:, [0, 1]] - own[:, [3, 4]], atol=1e-12)
    np.testing.assert_allclose(told[:, [3, 4]], -told[:, [0, 1]], atol=1e-12)
    np.testing.assert_allclose(told[:, [2, 5]], chance[:, [2, 2]] + own[:, [2, 5]], atol=1e-12)


@pytest.mark.parametrize("change", [{"critic": "network"}, {"critic": "quadratic", "blades": 7, "batch": 64}])
def test_twins_are_even_in_number_and_valued_in_closed_form(change):
    with pytest.raises(ValueError, match="settings.twins is True, but must be false unless critic is 'quadratic'"):
        PPOSettings(twins=True, **change)


def test_an_estimate_is_the_regression_of_slow_modes_and_loads_on_oscillators():
    task = resolve_task(**SHORT)
    generator, half = np.random.default_rng(0), task.plant.blade_states // 2
    mixing, n = generator.normal(size=(9, len(task.plant.A) + 2)), len(task.plant.A)
    regression, oscillators = Regression(task, modes=2), generator.normal(size=(400, 9))
    truth = oscillators @ mixing
    regression.add(oscillators[:150], truth[:150, :n], truth[:150, n:])
    regression.add(oscillators[150:], truth[150:, :n], truth[150:, n:])
    shown = oscillators @ regression.fit()
    wanted = truth[:, [0, 1, half, half + 1, n, n + 1]]
    scale = (shown * wanted).sum(axis=0) / (shown**2).sum(axis=0)
    np.testing.assert_allclose(scale * shown, wanted, atol=1e-3 * np.abs(wanted).max())
    np.testing.assert_allclose(scale[:4], scale[0], rtol=1e-4)  # one unit for the modes
    np.testing.assert_allclose(scale[4:], LOAD_UNIT, rtol=1e-4)


def test_a_training_on_an_estimate_resumes_bit_for_bit():
    task = resolve_task(**SHORT)
    training, again = (PPOTraining([task], PPOSettings(**ESTIMATE), 0) for _ in range(2))
    for _ in range(6):
        training.update(1.0)
    state = deepcopy(training.state_dict())
    training.update(1.0)
    again.load_state_dict(state)
    again.update(1.0)
    own, other = training.policy().weights, again.policy().weights
    for name in ("weight0", "shown"):
        np.testing.assert_array_equal(own[name], other[name])
        assert own[name].any()
