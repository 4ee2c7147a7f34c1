"""Runs of millions of steps: nothing drifts, nothing is left behind in memory, nothing stops being a number."""

import gc
import os
from collections.abc import Iterator
from pathlib import Path

import gymnasium
import numpy as np
import pytest

from beamenv import ENV_ID, SensorHistory, VectorPlacementWrapper
from beamenv.scenarios.scenario import SCENARIOS

DURATION, INTERVALS = 0.1, 200
"""Of an episode: s, and control intervals."""
LEFT_BEHIND = 4 * 2**20
"""Bytes by which a run may grow once it is warm: pages that the allocator keeps back. A batch's readings of one step take 16 kB."""
STATM = Path("/proc/self/statm")

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not STATM.exists(), reason="only Linux tells how much memory is resident")]


def resident() -> int:
    """Bytes of memory that the process has now."""
    gc.collect()
    return int(STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def driven(envs, steps: int) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray, dict]]:
    """Step under random voltages, some beyond the limits; every number is one, every reading in its space."""
    generator = np.random.default_rng(1)
    for _ in range(steps):
        observation, reward, terminated, truncated, info = envs.step(generator.uniform(-1.2, 1.2, envs.action_space.shape))
        assert np.isfinite(reward).all() and np.all(np.abs(observation) <= 1.0)
        assert all(np.isfinite(info[name]).all() for name in ("volts", "tip_displacement", "energy", "effort", "cost_increment"))
        yield observation, reward, terminated | truncated, info


def totals(envs, episodes: int, mode: str) -> np.ndarray:
    """(episodes, N): the rewards of whole episodes, all as long as each other, added up."""
    between = mode == "NextStep"
    whole = np.zeros((episodes, envs.num_envs))
    for k, (_, reward, over, _) in enumerate(driven(envs, episodes * (INTERVALS + between))):
        whole[k // (INTERVALS + between)] += reward
        assert over.all() == ((k + 1) % (INTERVALS + between) == (INTERVALS if between else 0))
    return whole


def assert_alike(first: np.ndarray, last: np.ndarray) -> None:
    """Means over independent blades are equal within four of their standard errors."""
    deviations = first.std(ddof=1) ** 2 / first.size + last.std(ddof=1) ** 2 / last.size
    assert abs(first.mean() - last.mean()) < 4.0 * np.sqrt(deviations)


@pytest.mark.parametrize("mode", ["SameStep", "NextStep"])
def test_two_million_steps_of_a_batch_neither_drift_nor_leak(mode):
    """A fault of 3 % in what an episode costs would show."""
    blades, episodes = 1000, 10

    def batch():
        return gymnasium.make_vec(ENV_ID, num_envs=blades, duration=DURATION, autoreset_mode=mode)

    envs = batch()
    envs.reset(seed=0)
    totals(envs, 1, mode)
    before = resident()
    costs = -totals(envs, episodes, mode)
    grown = resident() - before - costs.nbytes
    assert envs.num_envs * episodes * INTERVALS == 2_000_000
    assert grown < LEFT_BEHIND
    for part in (slice(0, 500), slice(500, 1000)):  # blades that lie apart in memory
        assert_alike(costs[:3, part].mean(axis=0), costs[-3:, part].mean(axis=0))
    new = batch()
    np.testing.assert_array_equal(envs.reset(seed=7)[0], new.reset(seed=7)[0])
    for old, fresh in zip(driven(envs, 250), driven(new, 250), strict=True):
        np.testing.assert_array_equal(old[0], fresh[0])
        np.testing.assert_array_equal(old[1], fresh[1])


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_hundred_thousand_steps_of_every_scenario_leave_nothing_behind(name):
    envs = gymnasium.make_vec(ENV_ID, num_envs=100, scenario=name, autoreset_mode="SameStep")
    envs.reset(seed=0)
    for _ in driven(envs, 1000):  # an episode of the usual length
        pass
    before, ends = resident(), 0
    for *_, over, _ in driven(envs, 1000):
        ends += over.sum()
    assert ends >= 100
    assert resident() - before < LEFT_BEHIND


def test_twenty_thousand_steps_seen_through_a_history_leave_nothing_behind():
    env = SensorHistory(gymnasium.make(ENV_ID, duration=DURATION))
    observation, _ = env.reset(seed=0)
    costs, before = [], 0
    for k in range(22_000):
        if k == 2_000:
            before = resident()
        action = np.sin(0.3 * k + np.arange(4)).astype(np.float32)
        observation, reward, terminated, truncated, info = env.step(action)
        assert np.isfinite(observation).all() and np.isfinite(reward) and np.isfinite(info["volts"]).all()
        window = observation.reshape(12, 8)
        np.testing.assert_allclose(window[-1, 4:], action, atol=1e-6)
        costs.append(-reward)
        if terminated or truncated:
            env.reset()
    assert resident() - before < LEFT_BEHIND
    episodes = np.array(costs).reshape(-1, INTERVALS).sum(axis=1)
    assert_alike(episodes[:40], episodes[-40:])


def test_layouts_that_are_drawn_anew_leave_nothing_of_the_old_ones_behind():
    envs = gymnasium.make_vec(ENV_ID, num_envs=32, duration=DURATION, autoreset_mode="NextStep")
    envs = VectorPlacementWrapper(envs, actuators={"low": 0.0, "high": 1.2}, bank=2)
    sizes = []
    for _ in range(12):
        layout = envs.reset(seed=None)[1]["layout"]["actuators"]
        assert len(np.unique(layout, axis=0)) == 2
        for *_, info in driven(envs, 2 * INTERVALS):
            np.testing.assert_array_equal(info["layout"]["actuators"], layout)
        sizes.append(resident())
    assert sizes[-1] - sizes[3] < LEFT_BEHIND
