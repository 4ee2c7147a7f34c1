"""SAC and TQC: a few updates, the kept network, and who sees what."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from beamenv.task import resolve_task
from train.learning.sb3.off_policy import OffPolicySettings, SACTraining, TQCTraining

SHORT = {"duration": 0.01}  # 20 control intervals
TINY = OffPolicySettings(
    blades=8, history=3, rollout=4, gradient_steps=2, batch=16, buffer=256, first=64, units=16, critic_units=16, critic_first=0
)

KINDS = pytest.mark.parametrize("kind", [SACTraining, TQCTraining])


def trained(kind, settings=TINY, updates=4, seed=0):
    training = kind([resolve_task(**SHORT)], settings, seed)
    for update in range(updates):
        training.update(1.0 - update / updates)
    return training


@KINDS
def test_a_few_updates_change_the_actor_and_tell_their_losses(kind):
    before, after = (trained(kind, updates=updates).policy().weights for updates in (0, 4))
    assert all((before[name] != weight).any() for name, weight in after.items())
    training = trained(kind)
    assert {"train/actor_loss", "train/critic_loss", "train/ent_coef"} <= set(training.losses)
    assert (training.steps, training.updates) == (8 * 4 * 4 * TINY.held, 4)


@KINDS
def test_learning_begins_when_enough_is_remembered(kind):
    training = kind([resolve_task(**SHORT)], replace(TINY, first=96), 0)
    learnt = []
    for _ in range(4):  # 32 actions each
        training.update(1.0)
        learnt.append("train/actor_loss" in training.losses)
    assert learnt == [False, False, True, True]


@KINDS
@pytest.mark.parametrize("activation", ["tanh", "relu"])
def test_the_kept_policy_is_the_most_likely_action(kind, activation):
    training = trained(kind, replace(TINY, held=1, activation=activation))
    training.model.actor.mu.weight.data *= 1e3
    policy, envs, memory = training.policy(), training.envs, None
    observations = envs.reset()
    observations, _, _, _ = envs.step(np.zeros((8, 4)))
    rows = observations[:, : envs.seen]
    memory = np.hstack([np.zeros((8, 8)), rows[:, :16], np.zeros((8, 5))]).astype(np.float32)[:, 8:]
    memory = np.hstack([np.zeros((8, 8), np.float32), memory[:, :16], np.zeros((8, 1), np.float32), rows[:, -4:]])
    action, _ = policy.predict(rows.reshape(8, 3, 8)[:, -1, :4], memory)
    np.testing.assert_allclose(action, training.model.predict(observations, deterministic=True)[0], atol=1e-5)
    assert np.abs(action).max() > 0.01


@KINDS
def test_critics_see_the_state_and_the_actor_does_not(kind):
    training = trained(kind)
    observations, actions = torch.as_tensor(training.envs.reset()), torch.zeros(8, 4)
    other = observations.clone()
    other[:, training.envs.seen :] += 1.0
    model = training.model
    with torch.no_grad():
        torch.testing.assert_close(model.actor(observations, True), model.actor(other, True), rtol=0.0, atol=0.0)
        first, second = (model.critic(rows, actions) for rows in (observations, other))
    assert (torch.as_tensor(first[0]) != torch.as_tensor(second[0])).any()


@KINDS
def test_the_same_seed_trains_the_same_agent(kind):
    first, second = trained(kind).policy(), trained(kind).policy()
    for name, weight in first.weights.items():
        np.testing.assert_array_equal(weight, second.weights[name])


def test_an_unknown_activation_is_refused():
    with pytest.raises(ValueError, match="settings.activation is 'step', but must be one of tanh, relu"):
        OffPolicySettings(activation="step")
