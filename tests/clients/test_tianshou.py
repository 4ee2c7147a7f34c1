"""Tianshou collects and learns."""

import gymnasium
import numpy as np
import pytest

import beamenv  # noqa: F401 - registers

pytest.importorskip("tianshou")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]


def test_its_vectorisations_step_the_blade():
    from tianshou.env import DummyVectorEnv, SubprocVectorEnv

    for kind in (DummyVectorEnv, SubprocVectorEnv):
        envs = kind([lambda: gymnasium.make("beamenv:beamenv/RotatingBeam-v0", duration=0.01)] * 2)
        envs.seed([1, 2])
        observations, _ = envs.reset()
        assert observations.shape == (2, 4)
        for _ in range(20):
            _, rewards, _, truncated, _ = envs.step(np.zeros((2, 4)))
        assert truncated.all() and np.isfinite(rewards).all()
        envs.close()


def test_its_collector_fills_a_buffer():
    from tianshou.algorithm.algorithm_base import Policy
    from tianshou.data import Batch, Collector, VectorReplayBuffer
    from tianshou.env import DummyVectorEnv

    class Idle(Policy):
        def forward(self, batch, state=None, **kwargs):
            return Batch(act=np.zeros((len(batch.obs), 4)), state=state)

    envs = DummyVectorEnv([lambda: gymnasium.make("beamenv/RotatingBeam-v0", duration=0.01)] * 2)
    collector = Collector(Idle(action_space=envs.action_space[0]), envs, VectorReplayBuffer(100, 2))
    collector.reset()
    assert collector.collect(n_episode=2).n_collected_steps == 40
