"""One round of an environment, or of a batch: steps, pictures and the time that they take."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any


def single_run(env: Any, steps: int = 20_000) -> Callable[[], float]:
    """Steps/s of one round of a single environment, resets included, with actions drawn beforehand."""
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(100)]
    env.reset(seed=0)

    def run() -> float:
        start = time.perf_counter()
        for k in range(steps):
            _, _, terminated, truncated, _ = env.step(actions[k % 100])
            if terminated or truncated:
                env.reset()
        return steps / (time.perf_counter() - start)

    return run


def picture_run(env: Any, steps: int = 100) -> Callable[[], float]:
    """Pictures/s of one round of a single environment that steps and draws, with the last 0.2 s full of curves."""
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(steps)]
    env.reset(seed=0)
    for k in range(500):
        env.step(actions[k % steps])

    def run() -> float:
        start = time.perf_counter()
        for action in actions:
            env.step(action)
            env.render()
        return steps / (time.perf_counter() - start)

    return run


def batch_run(envs: Any, actions: Any, steps: int = 1_200_000) -> Callable[[], float]:
    """Environment steps/s of one round of a batch, with all noises, loads, rewards, info and autoresets."""
    calls = max(steps // envs.num_envs, 1)
    envs.reset(seed=0)

    def run() -> float:
        start = time.perf_counter()
        for _ in range(calls):
            envs.step(actions)
        return calls * envs.num_envs / (time.perf_counter() - start)

    return run
