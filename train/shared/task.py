"""The task of an environment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium as gym

import beamenv
from beamenv.task import Task


def task_of(environment: Mapping[str, Any]) -> Task:
    """The task that an environment with the given keyword arguments has; ``ValueError`` for arguments that make none."""
    envs: Any = gym.make_vec(beamenv.ENV_ID, num_envs=1, **environment)
    envs.close()
    task: Task = envs.unwrapped.task
    return task
