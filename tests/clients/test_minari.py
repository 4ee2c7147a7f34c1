"""Minari loads, splits and plays what ``beamenv record`` writes; its own collector, which needs jax, records the environment."""

import gymnasium
import numpy as np
import pytest

import beamenv

minari = pytest.importorskip("minari")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]


def test_a_recorded_data_set_loads_by_its_name_and_plays(tmp_path, monkeypatch):
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    from beamenv.train.datasets import record

    record("lqg", "nominal", 6, environment={"duration": 0.01})
    data = minari.load_dataset("beamenv/lqg-nominal-v0")
    assert (data.total_episodes, data.total_steps) == (6, 120)
    env = data.recover_environment()
    first = next(iter(data.iterate_episodes()))
    np.testing.assert_array_equal(env.reset(seed=4_000_000)[0], first.observations[0])
    for step, action in enumerate(first.actions):
        np.testing.assert_array_equal(env.step(action)[0], first.observations[step + 1])
    assert [each.total_episodes for each in minari.split_dataset(data, [4, 2], seed=0)] == [4, 2]
    data.set_seed(0)
    assert len(data.sample_episodes(3)) == 3
    record("none", "nominal", 2, environment={"duration": 0.01})
    both = minari.combine_datasets([data, minari.load_dataset("beamenv/none-nominal-v0")], "beamenv/both-v0")
    assert both.total_episodes == 8


def test_a_data_set_goes_round(tmp_path, monkeypatch):
    pytest.importorskip("jax")
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    blade = {"patches": {"actuators": np.array([0.3, 0.9])}}
    recorded = minari.DataCollector(gymnasium.make(beamenv.ENV_ID, duration=0.01, blade=blade))
    rng, seen = np.random.default_rng(0), []
    for seed in range(2):
        seen.append([recorded.reset(seed=seed)[0]])
        truncated = False
        while not truncated:
            observation, _, _, truncated, _ = recorded.step(rng.uniform(-1.0, 1.0, 2).astype(np.float32))
            seen[-1].append(observation)
    made = recorded.create_dataset("beamenv/test-v0", algorithm_name="random")
    assert made.total_steps == 40
    again = minari.load_dataset("beamenv/test-v0")
    env = again.recover_environment()
    for seed, episode in enumerate(again.iterate_episodes()):
        np.testing.assert_array_equal(episode.observations, seen[seed])
        np.testing.assert_array_equal(env.reset(seed=seed)[0], episode.observations[0])
        for step, action in enumerate(episode.actions):
            np.testing.assert_array_equal(env.step(action)[0], episode.observations[step + 1])
