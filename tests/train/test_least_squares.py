"""SAC whose critic is fitted in closed form."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from scipy.linalg import solve_discrete_lyapunov

from beamenv.task import resolve_task
from train.learning.sb3.least_squares import ActionValues
from train.learning.sb3.off_policy import OffPolicySettings, SACTraining, TQCTraining

SHORT = {"duration": 0.01}  # 20 control intervals
TASKS = [resolve_task(**SHORT)]
TINY = OffPolicySettings(blades=8, sees="belief", modes=2, actor="linear", critic="quadratic", held=1, rollout=8, batch=16)
TINY = replace(TINY, buffer=256, first=64, samples=64, gradient_steps=2, critic_first=2, damping=0.02)


def trained(settings=TINY, updates=4, kind=SACTraining):
    training = kind(TASKS, settings, 0)
    for update in range(updates):
        training.update(1.0 - update / updates)
    return training


def test_action_values_of_an_oscillator_under_a_gain_are_those_of_lyapunovs_equation():
    generator, discount = np.random.default_rng(0), 0.9
    transition, entry, gain = np.array([[0.9, 0.3], [-0.3, 0.9]]), np.array([[0.0], [0.5]]), np.array([[0.1, -0.4]])
    states, actions = generator.normal(size=(4000, 2)), generator.normal(size=(4000, 1))
    following = states @ transition.T + actions @ entry.T
    rewards = -(states**2).sum(axis=1) - 0.1 * actions[:, 0] ** 2
    critic = ActionValues(width=4, actions=1, modes=1, told=0, crossed=0)
    before, after = (torch.as_tensor(np.hstack([rows, np.zeros((4000, 2))]), dtype=torch.float32) for rows in (states, following))
    features = critic.features(before, torch.as_tensor(actions, dtype=torch.float32))
    chosen = torch.as_tensor(following @ gain.T, dtype=torch.float32)
    differences = features - discount * critic.features(after, chosen)
    right = torch.as_tensor(rewards, dtype=torch.float32) @ features
    critic.solve(torch.cat([features.T @ differences, right[None], (features**2).sum(dim=0)[None]]).double() / 4000, 0.0)

    closed = transition + entry @ gain
    weight = np.eye(2) + 0.1 * gain.T @ gain
    value = solve_discrete_lyapunov(np.sqrt(discount) * closed.T, weight)
    exact = rewards - discount * np.einsum("ni,ij,nj->n", following, value, following)
    found = critic(before, torch.as_tensor(actions, dtype=torch.float32))[0][:, 0].detach().numpy()
    np.testing.assert_allclose(found, exact, rtol=0.0, atol=0.02 * np.abs(exact).max())


def test_no_action_value_curves_upwards_in_the_action():
    critic = ActionValues(width=4, actions=2, modes=1, told=0, crossed=0)
    count = len(critic.quadratic.weight)
    wanted = torch.linspace(-1.0, 1.0, count, dtype=torch.float64)
    critic.solve(torch.cat([torch.eye(count, dtype=torch.float64), wanted[None], torch.zeros(1, count)]), 0.0)
    values = [float(critic(torch.zeros(1, 4), torch.tensor([[np.cos(angle), np.sin(angle)]]).float())[0]) for angle in np.arange(8)]
    at_rest = float(critic(torch.zeros(1, 4), torch.zeros(1, 2))[0])
    assert max(values) <= at_rest + 1e-6
    assert min(values) < at_rest


def test_a_linear_actor_begins_without_voltages_and_moves_once_its_critic_is_known():
    weights = [trained(updates=updates).policy().weights["weight0"] for updates in (0, 2, 4)]
    assert not weights[0].any()
    assert not weights[1].any()
    assert weights[2].any()


def test_the_kept_policy_is_the_most_likely_action():
    training = trained()
    training.model.actor.mu.weight.data *= 1e2
    policy, observations = training.policy(), training.envs.reset()
    shown = observations[:, : training.envs.seen]
    wanted = training.model.predict(observations, deterministic=True)[0]
    np.testing.assert_allclose(np.tanh(shown @ policy.weights["weight0"].T + policy.weights["bias0"]), wanted, atol=1e-5)
    assert policy.settings["squashed"]


def test_it_resumes_bit_for_bit():
    straight = SACTraining(TASKS, TINY, 0)
    for _ in range(6):
        straight.update(0.5)
    halves = SACTraining(TASKS, TINY, 0)
    for _ in range(3):
        halves.update(0.5)
    state = halves.state_dict()
    resumed = SACTraining(TASKS, TINY, 0)
    resumed.load_state_dict(state)
    for _ in range(3):
        resumed.update(0.5)
    for name, weight in straight.policy().weights.items():
        np.testing.assert_array_equal(resumed.policy().weights[name], weight)


def test_a_quadratic_critic_is_sacs_on_one_scenario():
    with pytest.raises(ValueError, match="settings.critic is 'quadratic', but must be 'network' unless SAC"):
        trained(kind=TQCTraining)
    with pytest.raises(ValueError, match="settings.critic is 'quadratic'"):
        SACTraining([*TASKS, resolve_task(scenario="failure", **SHORT)], TINY, 0)


def test_an_action_held_for_a_whole_episode_has_no_next_one_to_fit_a_critic_by():
    with pytest.raises(ValueError, match="settings.held is 20, but must be below the 20 intervals of an episode"):
        SACTraining(TASKS, replace(TINY, held=20), 0)


def test_sums_that_are_not_finite_are_not_remembered():
    critic = ActionValues(width=4, actions=1, modes=1, told=0, crossed=0)
    critic.solve(torch.full_like(critic.sums, torch.nan), 0.5)
    assert not critic.sums.any()
    assert torch.isfinite(critic.quadratic.weight).all()
