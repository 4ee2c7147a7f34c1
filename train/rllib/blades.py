"""Blades as RLlib's env runners step them, one by one or in a batch: an agent sees the belief of a filter that knows the design.

It is what ``BeliefVecEnv`` shows agents of Stable-Baselines3, with its actions, rewards and plants. The environment as it is needs
nothing of this: ``"beamenv:beamenv/RotatingBeam-v0"`` is an environment of RLlib's, with ``gym_env_vectorize_mode`` a batch.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from train.learning.sb3.belief_vec_env import BeliefVecEnv

Array = NDArray[Any]

ENVIRONMENT = "beamenv/belief"
"""The name that ``register`` gives."""


class Blade(gymnasium.Env[Array, Array]):
    """One blade; ``arguments`` are those of ``BeliefVecEnv`` but ``num_envs`` and ``seed``."""

    def __init__(self, **arguments: Any) -> None:
        self._envs = BeliefVecEnv(1, **arguments)
        self._envs.seed(None)  # others draw other episodes
        self.observation_space, self.action_space = self._envs.observation_space, self._envs.action_space

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin an episode."""
        super().reset(seed=seed)
        if seed is not None:
            self._envs.seed(seed)
        return self._envs.reset()[0], {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Hold an action."""
        stepped: Any = self._envs.step(np.asarray(action)[None])
        observations, rewards, ended, infos = stepped
        cut = bool(ended[0]) and infos[0]["TimeLimit.truncated"]
        last = infos[0]["terminal_observation"] if ended[0] else observations[0]
        return last, float(rewards[0]), bool(ended[0]) and not cut, cut, {}

    def close(self) -> None:
        """Close the blade."""
        self._envs.close()


class Blades(VectorEnv[Array, Array, Array]):
    """``num_envs`` blades in one batch; further ``arguments`` as ``Blade`` has them.

    RLlib wants an episode to begin in the step after the last one. The batch cannot wait: the first action of such an episode
    is the one that RLlib gives and does not count, and the observation after it is its first.
    """

    def __init__(self, num_envs: int, **arguments: Any) -> None:
        self._envs = BeliefVecEnv(num_envs, **arguments)
        self._envs.seed(None)
        self.num_envs = num_envs
        self.metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP}
        self.single_observation_space, self.single_action_space = self._envs.observation_space, self._envs.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._over = np.zeros(num_envs, dtype=np.bool_)

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin the episodes, out of step with one another; one seed is that of the batch, and of several the first is."""
        if seed is not None:
            self._envs.seed(seed if isinstance(seed, int) else next(iter(seed)))
        self._over[...] = False
        return self._envs.reset(), {}

    def step(self, actions: Array) -> tuple[Array, Array, Array, Array, dict[str, Any]]:
        """Hold an action on each blade."""
        stepped: Any = self._envs.step(actions)
        observations, rewards, ended, infos = stepped
        observations, over = observations.copy(), ended & ~self._over
        cut = np.zeros_like(over)
        for row in np.flatnonzero(over).tolist():
            observations[row] = infos[row]["terminal_observation"]
            cut[row] = infos[row]["TimeLimit.truncated"]
        rewards = np.where(self._over, 0.0, rewards)
        self._over = over
        return observations, rewards, over & ~cut, cut, {}

    def close(self, **arguments: Any) -> None:
        """Close the batch."""
        self._envs.close()


def made(arguments: Mapping[str, Any]) -> Blade | Blades:
    """A blade, or a batch where ``num_envs`` says how many."""
    given = dict(arguments)
    return Blades(**given) if "num_envs" in given else Blade(**given)


def register(name: str = ENVIRONMENT) -> str:
    """Make the blades known to RLlib by a name, which is given back, on whatever machine its env runners are."""
    from ray.tune import register_env

    register_env(name, made)
    return name
