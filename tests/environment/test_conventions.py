"""The environments under other people's scripts and wrappers, unchanged."""

import ast
from importlib import import_module
from pathlib import Path

import gymnasium
import numpy as np
import pytest
import torch
import yaml
from gymnasium import wrappers
from gymnasium.wrappers import vector as vector_wrappers
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import VecNormalize
from torch import nn
from torch.distributions import Normal

import beamenv

SHORT = {"duration": 0.01}
"""20 control intervals."""


def test_statistics_of_an_episode_are_its_return_and_length():
    env = wrappers.RecordEpisodeStatistics(gymnasium.make(beamenv.ENV_ID, **SHORT))
    env.reset(seed=0)
    total, truncated = 0.0, False
    while not truncated:
        _, reward, _, truncated, info = env.step(np.zeros(4))
        total += reward
    assert info["episode"]["l"] == 20
    assert info["episode"]["r"] == pytest.approx(total)


def test_stacked_frames_are_the_last_readings():
    env = wrappers.FrameStackObservation(gymnasium.make(beamenv.ENV_ID, **SHORT), 3)
    env.reset(seed=0)
    readings = [env.step(np.full(4, 0.1 * k))[0] for k in range(4)]
    assert readings[-1].shape == (3, 4)
    np.testing.assert_array_equal(readings[-1][1], readings[-2][2])


def test_normalised_rewards_have_the_sign_of_the_plain_ones():
    env = wrappers.NormalizeReward(gymnasium.make(beamenv.ENV_ID, scenario="pulse", **SHORT))
    env.reset(seed=0)
    rewards = [env.step(np.zeros(4))[1] for _ in range(20)]
    assert all(np.isfinite(rewards)) and all(reward <= 0.0 for reward in rewards)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_vector_wrappers_take_the_native_batch(mode):
    if mode == "SameStep" and gymnasium.__version__.startswith("1.2."):
        pytest.skip("RecordEpisodeStatistics counts a step too few in SameStep before Gymnasium 1.3")
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, autoreset_mode=mode, **SHORT)
    envs = vector_wrappers.RecordEpisodeStatistics(envs)
    envs = vector_wrappers.NormalizeReward(vector_wrappers.ClipReward(envs, -10.0, 0.0))
    envs.reset(seed=0)
    lengths = []
    for _ in range(45):
        _, rewards, _, truncated, info = envs.step(np.zeros((3, 4)))
        assert np.isfinite(rewards).all()
        if truncated.any():
            lengths += info["episode"]["l"][truncated].tolist()
    assert lengths == [20] * len(lengths) and len(lengths) == 6


def make_env():
    """As cleanrl's ppo_continuous_action.py makes it."""
    env = wrappers.FlattenObservation(gymnasium.make(beamenv.ENV_ID, **SHORT))
    env = wrappers.ClipAction(wrappers.RecordEpisodeStatistics(env))
    env = wrappers.NormalizeObservation(env)
    env = wrappers.TransformObservation(env, lambda seen: np.clip(seen, -10, 10), env.observation_space)
    env = wrappers.NormalizeReward(env, gamma=0.99)
    return wrappers.TransformReward(env, lambda reward: np.clip(reward, -10, 10))


def test_a_script_in_cleanrl_s_manner_learns_on_it():
    """Rollout, generalised advantages and one clipped update: the actor changes and stays finite."""
    torch.manual_seed(0)
    envs = gymnasium.vector.SyncVectorEnv([make_env] * 2)
    actor, critic = nn.Linear(4, 4), nn.Linear(4, 1)
    before = actor.weight.detach().clone()
    optimiser = torch.optim.Adam([*actor.parameters(), *critic.parameters()], lr=1e-3)
    seen, _ = envs.reset(seed=1)
    rows = []
    for _ in range(32):
        observed = torch.as_tensor(seen, dtype=torch.float32)
        policy = Normal(actor(observed), 0.3)
        action = policy.sample()
        seen, reward, terminated, truncated, _ = envs.step(action.numpy())
        done = torch.as_tensor(terminated | truncated, dtype=torch.float32)
        rows.append((observed, action, policy.log_prob(action).sum(1).detach(), torch.as_tensor(reward, dtype=torch.float32), done))
    observed, action, old, reward, done = (torch.stack(part) for part in zip(*rows, strict=True))
    values = critic(observed).squeeze(-1)
    advantages, last = torch.zeros_like(reward), torch.zeros(2)
    for t in reversed(range(31)):
        delta = reward[t] + 0.99 * values[t + 1].detach() * (1 - done[t]) - values[t].detach()
        last = advantages[t] = delta + 0.99 * 0.95 * (1 - done[t]) * last
    ratio = (Normal(actor(observed), 0.3).log_prob(action).sum(-1) - old).exp()
    loss = torch.max(-advantages * ratio, -advantages * ratio.clamp(0.8, 1.2)).mean()
    (loss + 0.5 * ((values - advantages - values.detach()) ** 2).mean()).backward()
    optimiser.step()
    assert torch.isfinite(actor.weight).all()
    assert not torch.equal(actor.weight, before)


def zoo_settings():
    text = (Path(__file__).parents[2] / "train" / "learning" / "zoo" / "ppo.yml").read_text(encoding="utf-8")
    return yaml.safe_load(text)[beamenv.ENV_ID]


def test_the_zoo_s_hyperparameters_train_a_model():
    """Read as rl-baselines3-zoo reads them: wrappers by path, normalisation and policy arguments as Python literals."""
    settings = zoo_settings()
    ((path, arguments),) = settings.pop("env_wrapper")[0].items()
    module, name = path.rsplit(".", 1)
    wrapper = getattr(import_module(module), name)
    keywords = ast.parse(settings.pop("policy_kwargs"), mode="eval").body.keywords
    policy_kwargs = {each.arg: ast.literal_eval(each.value) for each in keywords}
    envs = make_vec_env(beamenv.ENV_ID, 2, env_kwargs=SHORT, wrapper_class=wrapper, wrapper_kwargs=arguments)
    envs = VecNormalize(envs, gamma=settings["gamma"], **ast.literal_eval(settings.pop("normalize")))
    for name in ("n_envs", "n_timesteps"):
        assert settings.pop(name) > 0
    model = PPO(env=envs, policy_kwargs=policy_kwargs, device="cpu", **{**settings, "n_steps": 16, "batch_size": 32})
    model.learn(32)
    assert model.num_timesteps == 32


@pytest.mark.filterwarnings("ignore")  # of skrl's own dependencies
def test_skrl_wraps_single_and_batched():
    wrap_env = pytest.importorskip("skrl.envs.wrappers.torch").wrap_env
    for made, count in ((gymnasium.make(beamenv.ENV_ID, **SHORT), 1), (gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, **SHORT), 3)):
        env = wrap_env(made, wrapper="gymnasium", verbose=False)
        observations, _ = env.reset()
        assert observations.shape == (count, 4)
        _, rewards, terminated, truncated, _ = env.step(torch.zeros(count, 4))
        assert rewards.shape == terminated.shape == truncated.shape == (count, 1)
