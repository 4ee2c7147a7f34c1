"""Agents of Stable-Baselines3 on the belief of a filter: what they see, how voltages approach actions, what is kept."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from stable_baselines3 import PPO

from baselines import PersistentLoad, lqg
from beamenv.plant.plant import drive_limit
from beamenv.task import resolve_task
from train.comparison.compare import Comparison
from train.controllers.policy_files import load_policy, save_policy
from train.learning.recipe import named_recipe
from train.learning.sb3.belief import OSCILLATORS, RollingBelief, design_belief, oscillator_bank, regulator_on
from train.learning.sb3.belief_vec_env import BeliefVecEnv
from train.learning.sb3.off_policy import OffPolicySettings, SACTraining
from train.learning.sb3.ppo import PPOSettings, PPOTraining
from train.learning.sb3.quadratic import Quadratic
from train.learning.sb3.recurrent_ppo import RecurrentPPOSettings
from train.learning.sb3.vec_env import TrainingVecEnv
from train.shared.curve import LOOKED, drawn_as, kept_cost, read_curve, write_curve

SHORT = {"duration": 0.01}  # 20 control intervals
TINY = PPOSettings(
    blades=8, sees="belief", modes=3, actor="linear", critic="quadratic", held=2, approach=0.5, rollout=8, batch=64, epochs=1
)


@pytest.fixture(scope="module")
def task():
    return resolve_task(**SHORT)


def trained(settings, task, updates=2, kind=PPOTraining):
    training = kind([task], settings, 0)
    for _ in range(updates):
        training.update(1.0)
    return training


def test_the_belief_is_the_estimate_of_lqg_with_load_estimate(task):
    plant = task.design.full_plant
    law, belief = lqg(plant, persistent_load=PersistentLoad()), design_belief(task.design, 3)
    kept, memory, generator = RollingBelief(2, belief), np.zeros((2, law.order)), np.random.default_rng(0)
    readings = generator.uniform(-0.02, 0.02, (30, 2, 4))
    voltages = generator.uniform(-0.02, 0.02, (30, 2, 4))
    kept.begin(readings[0])
    for before, after, held in zip(readings[:-1], readings[1:], voltages[1:], strict=True):
        measured = before * plant.sensor_full_scale
        memory = memory @ law.transition.T + measured @ law.measurement_input.T + held * drive_limit(plant) @ law.voltage_input.T
        kept.append(after, held)
    np.testing.assert_allclose(kept._before, memory, rtol=1e-3, atol=1e-4 * np.abs(memory).max())


def test_with_all_modes_the_regulator_on_the_belief_asks_for_lqgs_voltages(task):
    plant = task.design.full_plant
    law, belief = lqg(plant, persistent_load=PersistentLoad()), design_belief(task.design, plant.blade_states // 2)
    estimate = np.random.default_rng(1).normal(size=len(belief.transition)) * np.abs(belief.shown).max(axis=1)  # no electronics
    shown = np.append(estimate @ belief.shown, np.zeros(4))
    asked = regulator_on(belief, task.design) @ shown * drive_limit(plant)
    np.testing.assert_allclose(asked, law.state_gain @ estimate, rtol=1e-6)


def test_some_of_the_way_to_its_action_is_what_a_regulator_on_the_belief_needs(task):
    belief, voltages = design_belief(task.design, 4), np.array([0.1, -0.2, 0.0, 0.3])
    shown = np.append(np.random.default_rng(2).normal(size=10), voltages)
    whole, part = (regulator_on(belief, task.design, approach) @ shown for approach in (1.0, 0.25))
    np.testing.assert_allclose(voltages + 0.25 * (part - voltages), whole, atol=1e-12)


def test_an_oscillator_shows_a_reading_of_its_frequency_as_it_is_and_a_quarter_of_a_period_later(task):
    plant, place = task.design.plant, OSCILLATORS.index(40.0)
    bank = oscillator_bank(plant)
    kept, turned = RollingBelief(1, bank), 2.0 * np.pi * 40.0 * plant.control_interval * np.arange(1, 1001)
    kept.begin(np.zeros((1, 4)))
    for angle in turned:
        kept.append(np.array([[0.0, 0.1 * np.sin(angle), 0.0, 0.0]]), np.ones((1, 4)))
    shown = kept.window()[0, :-4].reshape(4, len(OSCILLATORS), 2)
    np.testing.assert_allclose(shown[1, place], [np.sin(turned[-1]), -np.cos(turned[-1])], atol=0.1)
    np.testing.assert_array_equal(shown[[0, 2, 3]], 0.0)  # neither other readings nor voltages get there


def test_more_modes_than_the_design_has_are_refused(task):
    with pytest.raises(ValueError, match="modes is 22, but must be at most the 21 of the design"):
        design_belief(task.design, 22)


@pytest.mark.parametrize("held", [1, 2])
def test_the_kept_policy_is_the_deterministic_actor_on_the_beliefs_of_training(task, held, tmp_path):
    training = trained(replace(TINY, held=held, start="lqg"), task)
    save_policy(training.policy(), tmp_path)
    policy, memory, starts, largest = load_policy(tmp_path), None, np.ones(8, dtype=bool), 0.0
    unseen = np.zeros((8, training.envs.observation_space.shape[0] - training.envs.seen), np.float32)
    filter_ = RollingBelief(8, training.envs.belief)
    readings = np.random.default_rng(3).uniform(-0.05, 0.05, (12, 8, 4)).astype(np.float32)
    filter_.begin(readings[0])
    voltages = np.zeros((8, 4), np.float32)
    for step, row in enumerate(readings):
        if step:
            filter_.append(row, voltages)
        if step % held == 0:
            asked = training.model.predict(np.hstack([filter_.window(), unseen]), deterministic=True)[0]
            voltages = voltages + np.float32(0.5) * (asked - voltages)
        action, memory = policy.predict(row, memory, episode_start=starts)
        starts = np.zeros(8, dtype=bool)
        np.testing.assert_allclose(action, voltages, atol=1e-5)
        largest = max(largest, np.abs(action).max())
    assert largest > 0.01


def test_voltages_go_the_same_share_of_the_way_to_an_action_at_each_decision(task):
    envs = TrainingVecEnv(4, task, 0, history=1, held=2, approach=0.25)
    envs.reset()
    action = np.full((4, 4), 0.4, np.float32)
    for expected in (0.1, 0.175, 0.23125):
        observations, _, ends, _ = envs.step(action)
        np.testing.assert_allclose(observations[~ends, -4:], expected, rtol=1e-6)
    assert not ends.all()


def test_a_quadratic_of_state_and_load_is_found_as_it_is():
    torch.manual_seed(0)
    critic, states = Quadratic(19, modes=6, seen=3), torch.randn(4000, 19)
    matrix = torch.randn(19, 19)
    matrix[15:17], matrix[:, 15:17] = 0.0, 0.0  # of the electronics squares alone are features
    returns = torch.einsum("bi,ij,bj->b", states, matrix, states) + 0.7 * states[:, 15] ** 2 - 3.0
    critic.fit(critic.features(states), returns)
    torch.testing.assert_close(critic(states)[:, 0], returns, rtol=1e-2, atol=5e-2)


def test_of_all_policies_the_one_that_validation_likes_best_is_kept_and_resumed_from(task):
    training, seen = PPOTraining([task], replace(TINY, validation=1), 0), []
    costs = iter([0.9, 0.5, 0.7])

    class Told:
        def cost(self, policy):
            seen.append(policy)
            return next(costs)

    training._validation = Told()
    for _ in range(3):
        training.update(1.0)
    again = PPOTraining([task], replace(TINY, validation=1), 0)
    again.load_state_dict(training.state_dict())
    for each in (training, again):
        np.testing.assert_array_equal(each.policies()[0].weights["weight0"], seen[1].weights["weight0"])
    assert training.validated == 0.7
    assert (seen[1].weights["weight0"] != seen[2].weights["weight0"]).any()


def test_validation_without_control_is_one(task):
    """An actor that has not learnt anything is no control, and both meet the same episodes."""
    training = PPOTraining([task], TINY, 0)
    assert training._validation.cost(training.policy()) == pytest.approx(1.0, abs=1e-12)


def test_curves_tell_what_validation_saw_and_the_policy_kept_is_the_best_seen(tmp_path):
    nobody = float("nan")
    write_curve(tmp_path, [(1.0, 10, 1, 0.9, nobody), (2.0, 20, 2, 0.8, 0.5), (3.0, 30, 3, 0.7, 0.6)])
    np.testing.assert_array_equal(read_curve(tmp_path), [(2.0, 20.0, 0.5), (3.0, 30.0, 0.6)])
    assert kept_cost(tmp_path) == 0.5
    assert drawn_as("ppo", tmp_path) == "ppo"
    write_curve(tmp_path, [(1.0, 10, 1, 0.9, 0.4), (2.0, 20, 2, 0.8, nobody), (3.0, 30, 3, 0.7, 0.6)], LOOKED)
    np.testing.assert_array_equal(read_curve(tmp_path), [(1.0, 10.0, 0.4), (3.0, 30.0, 0.6)])
    assert kept_cost(tmp_path) == 0.6  # who is looked at keeps the last
    write_curve(tmp_path, [(1.0, 10, 1, 0.7, nobody), (2.0, 20, 2, 0.8, nobody)])
    assert drawn_as("belief", tmp_path) == "belief, in training"
    np.testing.assert_array_equal(read_curve(tmp_path), [(1.0, 10.0, 0.7), (2.0, 20.0, 0.8)])
    assert kept_cost(tmp_path) == 0.8


def test_a_comparison_trains_by_recipes_too():
    comparison = Comparison(budget={"belief": 1.0, "ppo-belief": 1.0})
    assert comparison.recipe("ppo-belief").settings == named_recipe("ppo-belief").settings
    assert comparison.job("belief").recipe.settings == replace(named_recipe("belief").settings, runs=1)


def test_sac_sees_a_belief_too(task):
    settings = OffPolicySettings(
        blades=8,
        sees="belief",
        approach=0.5,
        rollout=4,
        gradient_steps=2,
        batch=16,
        buffer=256,
        first=64,
        units=16,
        critic_units=16,
    )
    policy = trained(settings, task, 3, SACTraining).policies()[0]
    action, _ = policy.predict(np.full((2, 4), 0.05, np.float32))
    assert np.isfinite(action).all()


@pytest.mark.parametrize("change", [{"sees": "belief"}, {"actor": "linear"}, {"critic": "quadratic"}, {"approach": 0.5}])
def test_cells_know_neither_beliefs_nor_what_goes_with_them(change):
    with pytest.raises(ValueError, match=f"settings.{next(iter(change))} is .*cells know nothing else"):
        RecurrentPPOSettings(**change)


def test_a_quadratic_critic_is_of_one_scenario(task):
    with pytest.raises(ValueError, match="settings.critic is 'quadratic', but must be 'network' where several scenarios"):
        PPOTraining([task, resolve_task(scenario="delay", **SHORT)], TINY, 0)


def test_a_plain_model_of_stable_baselines3_learns_on_beliefs_and_becomes_a_controller():
    envs = BeliefVecEnv(8, seed=1, approach=0.5, **SHORT)
    model = PPO("MlpPolicy", envs, n_steps=8, batch_size=32, n_epochs=1, seed=0, device="cpu").learn(64)
    controller = envs.controller(model)
    readings = np.full((3, 4), 0.05, np.float32)
    action, memory = controller.predict(readings)
    filter_ = RollingBelief(3, envs.belief)
    filter_.begin(readings)
    expected = 0.5 * np.clip(model.predict(filter_.window(), deterministic=True)[0], -1.0, 1.0)
    np.testing.assert_allclose(action, expected, atol=1e-6)
    assert memory.shape == (3, controller.memory_size)
