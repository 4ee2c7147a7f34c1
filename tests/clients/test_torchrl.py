"""TorchRL collects from the environment: one blade, the native batch, the batch of tensors."""

import gymnasium
import numpy as np
import pytest

import beamenv
from tests.clients.lines import assert_lines_run

torchrl_envs = pytest.importorskip("torchrl.envs")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]


def test_a_single_blade_rolls_out():
    rollout = torchrl_envs.GymEnv("beamenv:beamenv/RotatingBeam-v0", duration=0.01).rollout(30)
    assert rollout["observation"].shape == (20, 4)
    assert bool(rollout["next", "truncated"][-1])


def single(**arguments):
    return gymnasium.make(beamenv.ENV_ID, duration=0.01, **arguments)


def batch(**arguments):
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, autoreset_mode="Disabled", duration=0.01, **arguments)


MADE = {
    "one blade": single,
    "with a memory of readings": lambda: beamenv.SensorHistory(single(), 4),
    "with patches placed": lambda: beamenv.PlacementWrapper(single()),
    "a batch": batch,
    "in double precision": lambda: batch(dtype="float64"),
    "in volts and amperes": lambda: batch(physical_units=True),
    "with faults": lambda: batch(scenario="failure"),
    "a batch with a memory of readings": lambda: beamenv.VectorSensorHistory(batch(), 4),
    "a batch with patches placed": lambda: beamenv.VectorPlacementWrapper(batch()),
    "Gymnasium's own batch": lambda: gymnasium.make_vec(
        beamenv.ENV_ID,
        num_envs=3,
        vectorization_mode="sync",
        vector_kwargs={"autoreset_mode": gymnasium.vector.AutoresetMode.DISABLED},
        duration=0.01,
    ),
}


@pytest.mark.parametrize("made", MADE.values(), ids=MADE)
def test_what_it_does_is_within_its_specification(made):
    from torchrl.envs.utils import check_env_specs

    wrapped = torchrl_envs.GymWrapper(made())
    check_env_specs(wrapped, seed=0)
    assert wrapped.batch_size in ((), (3,))


def test_histories_of_a_batch_begin_anew_with_each_episode():
    wrapped = torchrl_envs.GymWrapper(beamenv.VectorSensorHistory(batch(), 4))
    rollout = wrapped.rollout(50, break_when_any_done=False)
    assert rollout["observation"].shape == (3, 50, 32)
    for k in (0, 20, 40):
        assert not rollout["observation"][:, k].reshape(3, -1)[:, :24].any()  # the past is empty
        assert rollout["observation"][:, k + 1].reshape(3, -1)[:, 16:24].any()


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


def test_the_lines_of_the_page_run(tmp_path):
    assert_lines_run("TorchRL", tmp_path)
