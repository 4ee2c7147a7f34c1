"""PPO and recurrent PPO: the network that is kept is the one that was trained."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
import torch
from gymnasium.vector import AutoresetMode

import beamenv
from beamenv.task import resolve_task
from train.learning.sb3.ppo import PPOSettings, PPOTraining
from train.learning.sb3.recurrent_ppo import RecurrentPPOSettings, RecurrentPPOTraining
from train.learning.sb3.vec_env import TrainingVecEnv

SHORT = {"duration": 0.01}  # 20 control intervals
TINY = PPOSettings(blades=8, history=3, rollout=4, batch=32, epochs=1, units=16)
TINY_RECURRENT = RecurrentPPOSettings(blades=8, history=3, held=3, rollout=4, batch=32, epochs=1, units=8)


def trained(kind, settings, updates=3, seed=0, environment=SHORT):
    training = kind([resolve_task(**environment)], settings, seed)
    for update in range(updates):
        training.update(1.0 - update / updates)
    return training


def enlarged(training):
    """Its output layer enlarged, to reach the limits."""
    training.model.policy.action_net.weight.data *= 100.0
    return training


def test_the_kept_policy_is_the_deterministic_actor_on_the_windows_of_training():
    training = enlarged(trained(PPOTraining, replace(TINY, held=1)))
    policy, envs = training.policy(), TrainingVecEnv(4, SHORT, 1, history=3, shows_state=True)
    observations, memory, starts = envs.reset(), None, np.ones(4, dtype=bool)
    largest = 0.0
    for _ in range(50):
        windows = observations[:, : envs.seen]
        action, memory = policy.predict(windows.reshape(4, 3, 8)[:, -1, :4], memory, episode_start=starts)
        np.testing.assert_allclose(memory[:, : envs.seen], windows, atol=1e-6)
        np.testing.assert_allclose(action, training.model.predict(observations, deterministic=True)[0], atol=1e-5)
        observations, _, starts, _ = envs.step(action)
        largest = max(largest, np.abs(action).max())
    assert largest > 0.1


@pytest.mark.parametrize(("kind", "settings"), [(PPOTraining, replace(TINY, held=4)), (RecurrentPPOTraining, TINY_RECURRENT)])
def test_between_decisions_the_kept_policy_holds_and_at_them_it_is_the_actor(kind, settings):
    training = enlarged(trained(kind, settings))
    policy = training.policy()
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=4, autoreset_mode=AutoresetMode.SAME_STEP, **SHORT)
    envs = beamenv.VectorSensorHistory(batch, length=3)
    windows, memory, cells, starts = envs.reset(seed=1)[0], None, None, np.ones(4, dtype=bool)
    unseen = np.zeros((4, training.envs.observation_space.shape[0] - windows.shape[1]), np.float32)
    for step in range(18):  # within one episode
        action, memory = policy.predict(windows.reshape(4, 3, 8)[:, -1, :4], memory, episode_start=starts)
        if step % settings.held == 0:
            told = {"episode_start": starts} if kind is RecurrentPPOTraining else {}
            expected, cells = training.model.predict(np.hstack([windows, unseen]), cells, deterministic=True, **told)
        np.testing.assert_allclose(action, expected, atol=1e-5)
        windows, _, _, _, _ = envs.step(action)
        starts = np.zeros(4, dtype=bool)
    assert np.abs(action).max() > 0.01


@pytest.mark.parametrize(("kind", "settings"), [(PPOTraining, TINY), (RecurrentPPOTraining, TINY_RECURRENT)])
def test_the_same_seed_trains_the_same_agent_and_another_another(kind, settings):
    first, second, other = (trained(kind, settings, seed=seed).policy() for seed in (0, 0, 1))
    for name, weight in first.weights.items():
        np.testing.assert_array_equal(weight, second.weights[name])
    assert any((weight != other.weights[name]).any() for name, weight in first.weights.items())


def test_a_critic_that_learns_first_leaves_the_actor_alone():
    training = PPOTraining([resolve_task(**SHORT)], replace(TINY, critic_first=2), 0)
    before = training.policy().weights
    value = [parameter.detach().clone() for parameter in training.model.policy.value_net.parameters()]
    for _ in range(2):
        training.update(1.0)
    for name, weight in training.policy().weights.items():
        np.testing.assert_array_equal(weight, before[name])
    assert any((old != new).any() for old, new in zip(value, training.model.policy.value_net.parameters(), strict=True))
    training.update(1.0)
    assert (training.policy().weights["weight0"] != before["weight0"]).any()


def test_running_costs_are_relative_to_no_control():
    """Hardly any voltage, so hardly anything but no control; from the second update whole episodes of all ages are in the batch."""
    alone = {"blades": 512, "rollout": 100, "batch": 51200, "learning_rate": 1e-9, "smoothing": 1.0}
    training = trained(PPOTraining, replace(TINY, exploration=-6.0, held=1, **alone), updates=2, environment={"duration": 0.05})
    assert training.cost == pytest.approx(1.0, abs=0.15)
    assert training.steps == 2 * 512 * 100


def test_a_recurrent_critic_sees_the_state_and_its_actor_does_not():
    training = trained(RecurrentPPOTraining, TINY_RECURRENT, updates=1)
    observations = torch.as_tensor(training.envs.reset())
    policy, cells = training.model.policy, tuple(torch.zeros(1, 8, 8) for _ in range(2))
    other = observations.clone()
    other[:, training.envs.seen :] += 1.0
    starts = torch.zeros(8)
    with torch.no_grad():
        actions = [policy.get_distribution(rows, cells, starts)[0].mode() for rows in (observations, other)]
        values = [policy.predict_values(rows, cells, starts) for rows in (observations, other)]
    torch.testing.assert_close(*actions, rtol=0.0, atol=0.0)
    assert (values[0] != values[1]).all()
