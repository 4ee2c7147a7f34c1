"""RLlib runs the environment in worker processes, which do not know the id without its module; and PPO as train.rllib has it."""

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("ray.rllib")
pytest.importorskip("stable_baselines3")

import beamenv
from beamenv.baselines import evaluate
from beamenv.task import resolve_task
from tests.clients.lines import assert_lines_run

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]

ENV_ID = "beamenv:beamenv/RotatingBeam-v0"
SHORT = {"duration": 0.02}  # twenty actions


@pytest.fixture(scope="module")
def cluster():
    import ray

    ray.init(address="local", num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield
    ray.shutdown()


@pytest.fixture
def rooms():
    import beamenv.train.rllib as rooms

    return rooms


@pytest.mark.parametrize(("runners", "mode"), [(0, "sync"), (1, "sync"), (1, "vector_entry_point")])
def test_the_environment_as_it_is_trains(cluster, runners, mode):
    from ray.rllib.algorithms.ppo import PPOConfig

    config = (
        PPOConfig()
        .environment(ENV_ID, env_config={"duration": 0.01})
        .env_runners(num_env_runners=runners, num_envs_per_env_runner=2, gym_env_vectorize_mode=mode)
        .training(train_batch_size=128, minibatch_size=64, num_epochs=1)
    )
    algorithm = config.build_algo()
    result = algorithm.train()
    algorithm.stop()
    assert np.isfinite(result["env_runners"]["episode_return_mean"])
    assert result["env_runners"]["episode_len_mean"] == 20


@pytest.mark.parametrize(("runners", "batched"), [(0, True), (0, False), (1, True)])
def test_two_iterations_change_the_gain_and_give_a_controller(cluster, rooms, runners, batched):
    config = rooms.ppo_config(8, 32, batched, **SHORT).env_runners(num_env_runners=runners).debugging(seed=0)
    algorithm = config.build_algo()
    untrained = rooms.policy_of(algorithm)
    results = [algorithm.train() for _ in range(2)]
    policy = rooms.policy_of(algorithm)
    algorithm.stop()
    assert np.isfinite(results[-1]["env_runners"]["episode_return_mean"])
    assert not untrained.weights["weight0"].any()
    assert policy.weights["weight0"].any()
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=4, **SHORT)
    idle = evaluate(untrained, envs, seeds=range(4))
    assert idle.relative_cost.value == 1.0
    assert np.isfinite(evaluate(policy, envs, seeds=range(4), reference=idle.reference).relative_cost.value)


def test_env_runners_elsewhere_need_none_of_the_files_here(rooms, tmp_path):
    (tmp_path / "calm.toml").write_text("sensor_noise = false\n")
    (tmp_path / "fast.json").write_text('{"speed": 150.0}')
    config = rooms.ppo_config(scenario=str(tmp_path / "calm.toml"), blade=tmp_path / "fast.json", **SHORT)
    for name in ("calm.toml", "fast.json"):
        (tmp_path / name).unlink()
    task = resolve_task(**{name: config.env_config[name] for name in ("scenario", "blade", "duration")})
    assert task.config.speed == 150.0 and not task.scenario.sensor_noise


def test_the_controller_does_what_the_network_asks_for(cluster, rooms):
    import torch
    from ray.rllib.core.columns import Columns

    algorithm = rooms.ppo_config(8, 16, **SHORT).build_algo()
    network = algorithm.get_module()
    with torch.no_grad():
        network.gain.weight.copy_(0.01 * torch.arange(network.gain.weight.numel()).reshape(network.gain.weight.shape))
    policy = rooms.policy_of(algorithm)
    shown = np.random.default_rng(0).normal(size=(5, network.gain.weight.shape[1])).astype(np.float32)
    mean = network.forward_inference({Columns.OBS: torch.as_tensor(shown)})[Columns.ACTION_DIST_INPUTS][:, : len(policy.lowest)]
    algorithm.stop()
    np.testing.assert_allclose(policy.asked(shown), mean.numpy(), rtol=1e-5, atol=1e-6)


def test_a_batch_and_a_blade_have_episodes_as_gymnasium_has_them(rooms):
    from gymnasium.utils.env_checker import check_env

    check_env(rooms.Blade(**SHORT), skip_render_check=True)
    envs, single = rooms.Blades(4, held=2, **SHORT), rooms.Blade(held=2, **SHORT)
    observations, _ = envs.reset(seed=3)
    assert envs.observation_space.contains(observations)
    ends, before = [], np.zeros(4, dtype=bool)
    for _ in range(90):
        observations, rewards, terminated, truncated, _ = envs.step(envs.action_space.sample())
        assert not (before & (terminated | truncated)).any()  # the step after an episode's last begins the next one
        assert (rewards[before] == 0.0).all()
        before = terminated | truncated
        ends.append(truncated.copy())
    for rows in np.array(ends).T:
        assert set(np.diff(np.flatnonzero(rows))) == {20}
    first, again, other = (single.reset(seed=seed)[0] for seed in (3, 3, None))
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()
    assert (rooms.Blade(**SHORT).reset()[0] != rooms.Blade(**SHORT).reset()[0]).any()


def test_the_lines_of_the_page_run(tmp_path):
    assert_lines_run("RLlib", tmp_path)
