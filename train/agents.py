"""The agents by name, each trained within a time on an environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import gymnasium as gym
import numpy as np

import beamenv
from train.gradient import GradientSettings, train_gradient
from train.policies import Policy
from train.ppo import PPOSettings, train_ppo
from train.training import Report, one_torch_thread

AGENTS: Mapping[str, Callable[[], Any]] = {"gradient": GradientSettings, "ppo": PPOSettings}
"""The settings of each agent, by its short name."""


def train_agent(name: str, environment: Mapping[str, Any], budget: float, seed: int, report: Report) -> Policy:
    """Train an agent for ``budget`` s on the environment with the given keyword arguments; Ctrl-C ends training early.

    PPO meets the true blade, the gradient the design plant, as an LQG does. Raises ValueError for an unknown name or a budget
    that is not positive.
    """
    if name not in AGENTS:
        raise ValueError(f"agent = {name!r} must be one of {', '.join(AGENTS)}.")
    if not (np.isfinite(budget) and budget > 0.0):
        raise ValueError(f"seconds = {budget!r} must be a positive number.")
    with one_torch_thread():
        if name == "ppo":
            return train_ppo(environment, budget, seed, report)
        envs: Any = gym.make_vec(beamenv.ENV_ID, num_envs=1, **environment)
        task = envs.unwrapped.task
        envs.close()
        return train_gradient(task, seed, report, seconds=budget)[0]
