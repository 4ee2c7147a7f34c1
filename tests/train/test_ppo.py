"""PPO: the network that is kept is the one that was trained."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import beamenv
import train.ppo
from train.ppo import PPOSettings, train_ppo
from train.vec_env import BladeVecEnv

SHORT = {"duration": 0.01}  # 20 control intervals
TINY = PPOSettings(blades=8, history=3, rollout=4, batch=32, epochs=1, units=16)


def ignore(progress):
    pass


def trained(ticking, held):
    """SB3's model after 10 updates or so, its output layer enlarged to reach the limits, and the policy kept of it."""
    kept = {}

    def enlarge(model, plant, settings):
        model.policy.action_net.weight.data *= 100.0
        kept["model"] = model
        return distilled(model, plant, settings)

    distilled = train.ppo.distilled
    with pytest.MonkeyPatch.context() as patch, ticking(0.02):
        patch.setattr(train.ppo, "distilled", enlarge)
        policy = train_ppo(SHORT, 1.0, 0, ignore, replace(TINY, held=held))
    return kept["model"], policy


def test_the_kept_policy_is_the_deterministic_actor_on_the_windows_of_training(ticking):
    model, policy = trained(ticking, held=1)
    envs = BladeVecEnv(4, SHORT, 1, history=3, shows_state=True)
    observations, memory, starts = envs.reset(), None, np.ones(4, dtype=bool)
    largest = 0.0
    for _ in range(50):
        windows = observations[:, : envs.seen]
        action, memory = policy.predict(windows.reshape(4, 3, 8)[:, -1, :4], memory, episode_start=starts)
        np.testing.assert_allclose(memory[:, : envs.seen], windows, atol=1e-6)
        np.testing.assert_allclose(action, model.predict(observations, deterministic=True)[0], atol=1e-5)
        observations, _, starts, _ = envs.step(action)
        largest = max(largest, np.abs(action).max())
    assert largest > 0.1


def test_between_decisions_the_kept_policy_holds_and_at_them_it_is_the_actor(ticking):
    model, policy = trained(ticking, held=4)
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=4, autoreset_mode=AutoresetMode.SAME_STEP, **SHORT)
    envs = beamenv.VectorSensorHistory(batch, length=3)
    windows, memory, starts = envs.reset(seed=1)[0], None, np.ones(4, dtype=bool)
    unseen = np.zeros((4, model.observation_space.shape[0] - windows.shape[1]), np.float32)
    for step in range(50):
        action, memory = policy.predict(windows.reshape(4, 3, 8)[:, -1, :4], memory, episode_start=starts)
        if step % 4 == 0:
            expected = model.predict(np.hstack([windows, unseen]), deterministic=True)[0]
        np.testing.assert_allclose(action, expected, atol=1e-5)
        windows, _, terminated, truncated, _ = envs.step(action)
        starts = terminated | truncated


def test_the_same_seed_and_clock_train_the_same_agent(ticking):
    (_, first), (_, second) = trained(ticking, held=2), trained(ticking, held=2)
    for name, weight in first.weights.items():
        np.testing.assert_array_equal(weight, second.weights[name])


def test_an_interrupted_training_gives_what_it_has():
    def interrupt(progress):
        raise KeyboardInterrupt

    policy = train_ppo(SHORT, 60.0, 0, interrupt, TINY)
    assert policy.predict(np.zeros(4))[0].shape == (4,)


def test_running_costs_are_relative_to_no_control(ticking):
    """Hardly any voltage, so hardly anything but no control; episodes of all ages are in the batch from the second on."""
    seen = []
    with ticking(0.02):
        train_ppo({"duration": 0.05}, 2.0, 0, seen.append, replace(TINY, blades=256, exploration=-6.0, held=1, rollout=20))
    assert len(seen) >= 3
    assert [progress.steps for progress in seen] == sorted({progress.steps for progress in seen})
    assert all(0.05 < progress.cost < 2.0 for progress in seen)
