"""TorchRL collects from the environment: one blade, the native batch, the batch of tensors."""

import gymnasium
import numpy as np
import pytest

import beamenv

torchrl_envs = pytest.importorskip("torchrl.envs")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]


def test_a_single_blade_rolls_out():
    rollout = torchrl_envs.GymEnv("beamenv:beamenv/RotatingBeam-v0", duration=0.01).rollout(30)
    assert rollout["observation"].shape == (20, 4)
    assert bool(rollout["next", "truncated"][-1])


@pytest.mark.parametrize("mode", ["Disabled"])
def test_the_native_batch_rolls_out_through_the_ends_of_episodes(mode):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, autoreset_mode=mode, duration=0.01)
    envs.reset(seed=0)
    wrapped = torchrl_envs.GymWrapper(envs)
    rollout = wrapped.rollout(50, break_when_any_done=False)
    assert rollout["observation"].shape == (3, 50, 4)
    ends = np.flatnonzero(rollout["next", "done"][0, :, 0].numpy())
    np.testing.assert_array_equal(ends, [19, 39])


@pytest.mark.parametrize("mode", ["Disabled", "SameStep"])
def test_the_batch_of_tensors_rolls_out_through_the_ends_of_episodes(mode):
    envs = beamenv.torch_vec(3, device="cpu", autoreset_mode=mode, duration=0.01)
    envs.reset(seed=0)
    wrapped = torchrl_envs.GymWrapper(envs)
    torchrl_envs.check_env_specs(wrapped)
    rollout = wrapped.rollout(50, break_when_any_done=False)
    assert rollout["observation"].shape == (3, 50, 4)
    ends = np.flatnonzero(rollout["next", "done"][0, :, 0].numpy())
    np.testing.assert_array_equal(ends, [19, 39])
