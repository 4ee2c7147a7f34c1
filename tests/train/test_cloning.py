"""Behaviour cloning: a student comes to do as its teacher does."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from torch import nn

from beamenv.task import resolve_task
from train.learning.sb3.cloning import Cloning, Follower, clone
from train.learning.sb3.off_policy import OffPolicySettings, SACTraining
from train.learning.sb3.ppo import PPOSettings, PPOTraining
from train.learning.sb3.vec_env import TrainingVecEnv
from train.learning.through_plant.actors import ActorSettings, RecurrentActor

SHORT = {"duration": 0.02}  # 40 control intervals
BRIEF = Cloning(actions=60, samples=500, batch=64, gradient_steps=2)


@pytest.fixture(scope="module")
def teacher():
    torch.manual_seed(1)
    return RecurrentActor(resolve_task(**SHORT).design_plant, ActorSettings(units=6, output_gain=2.0), 1).policy(0)


def test_a_teacher_follows_windows_as_if_it_drove(teacher):
    """Its own actions, held for one interval each, come back in the windows: it must say the same again."""
    envs = TrainingVecEnv(3, SHORT, 0, history=4)
    follower, memory = Follower(teacher, 3, 4, held=1), None
    windows, begun = envs.reset(), np.ones(3, dtype=np.bool_)
    for _ in range(60):
        action, memory = teacher.predict(windows.reshape(3, 4, 8)[:, -1, :4], memory, episode_start=begun)
        np.testing.assert_allclose(follower.follow(windows, begun), action, atol=1e-6)
        windows, _, begun, _ = envs.step(action)


def test_a_teacher_overruled_goes_by_what_was_held(teacher):
    envs = TrainingVecEnv(3, SHORT, 0, history=4, held=3)
    follower, memory = Follower(teacher, 3, 4, held=3), None
    windows, begun = envs.reset(), np.ones(3, dtype=np.bool_)
    for step in range(8):
        wanted = follower.follow(windows, begun)
        for instant in range(2 if step else 0, -1, -1):
            rows = windows.reshape(3, 4, 8)[:, -1 - instant]
            memory = None if memory is None else teacher.knowing(memory, rows[:, 4:])
            action, memory = teacher.predict(rows[:, :4], memory)
        np.testing.assert_allclose(wanted, action, atol=1e-6)
        windows, _, begun, _ = envs.step(np.full((3, 4), 0.1 * (step % 3 - 1)))
        if begun.any():
            break


def test_cloning_reduces_the_error_of_regression(teacher):
    envs = TrainingVecEnv(8, SHORT, 0, history=4, held=2)
    torch.manual_seed(0)
    student = nn.Sequential(nn.Linear(32, 16), nn.Tanh(), nn.Linear(16, 4))
    errors = clone(student, envs, teacher, 1.0, BRIEF, 0)
    assert np.mean(errors[-10:]) < 0.3 * np.mean(errors[:10])


def test_a_teacher_must_be_shown_every_instant(teacher):
    envs = TrainingVecEnv(2, SHORT, 0, history=2, held=3)
    with pytest.raises(ValueError, match="history = 2 must be at least held = 3"):
        clone(nn.Linear(16, 4), envs, teacher, 1.0, BRIEF, 0)


@pytest.mark.parametrize(
    ("kind", "settings"),
    [
        (PPOTraining, PPOSettings(blades=8, rollout=4, batch=32, units=16, critic_first=1)),
        (SACTraining, OffPolicySettings(blades=8, buffer=256, first=64, batch=16, units=16, critic_units=16)),
    ],
)
def test_fine_tuning_begins_from_the_clone(kind, settings, teacher, monkeypatch):
    monkeypatch.setattr(f"{kind.__module__}.Cloning", lambda: replace(BRIEF, actions=120, gradient_steps=4))
    scratch, cloned = (kind([resolve_task(**SHORT)], settings, 0, each) for each in (None, teacher))
    rows = np.random.default_rng(0).uniform(-0.1, 0.1, (50, 4)).astype(np.float32)
    wanted = teacher.predict(rows)[0]
    errors = [np.mean((training.policy().predict(rows)[0] - wanted) ** 2) for training in (scratch, cloned)]
    assert errors[1] < 0.5 * errors[0]
    cloned.update(1.0)
