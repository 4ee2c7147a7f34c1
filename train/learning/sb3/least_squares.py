"""Soft actor-critic whose critic is fitted in closed form: least squares on temporal differences, from what is remembered.

Of a linear plant under a linear law Q is quadratic in the true state, the load, the belief, the voltages and the action
(Bradtke, Ydstie and Barto 1994), and least squares find the fixed point of Bellman's equation in these features without target networks or
rates (Bradtke and Barto 1996; Lagoudakis and Parr 2003). The actor, its entropy and its temperature are those of Stable-Baselines3.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import SAC
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor
from torch import Tensor, nn

from train.learning.sb3.asymmetric import AsymmetricSACPolicy
from train.learning.sb3.quadratic import MODES, Quadratic

Array = NDArray[Any]


class ActionValues(nn.Module):
    """Q = φᵀw of `Quadratic` features of [action | what ``told`` begins: belief or voltages, true state, load]."""

    def __init__(self, width: int, actions: int, modes: int, told: int, crossed: int, low: int = MODES) -> None:
        super().__init__()
        self.told = told
        self.quadratic = Quadratic(actions + width - told, modes, actions + crossed, low=low)

    def features(self, observations: Tensor, actions: Tensor) -> Tensor:
        """(B, k)."""
        return self.quadratic.features(torch.cat([actions, observations[:, self.told :]], dim=1))

    def forward(self, observations: Tensor, actions: Tensor) -> tuple[Tensor, ...]:
        """(B, 1), of the only critic."""
        return (self.quadratic(torch.cat([actions, observations[:, self.told :]], dim=1)),)

    def bend(self, actions: int) -> None:
        """Take away what curves upwards in the action, which no cost does."""
        quadratic, weight = self.quadratic, self.quadratic.weight
        own = (quadratic._first < actions) & (quadratic._second < actions)
        curvature = torch.zeros(actions, actions)
        curvature[quadratic._first[own], quadratic._second[own]] = weight[: len(own)][own]
        values, vectors = torch.linalg.eigh((curvature + curvature.T) / 2.0)
        bent = (vectors * values.clamp(max=0.0)) @ vectors.T
        bent = 2.0 * bent - torch.diag(torch.diag(bent))
        weight[: len(own)][own] = bent[quadratic._first[own], quadratic._second[own]]

    def set_training_mode(self, mode: bool) -> None:
        """Nothing depends on it."""


class LeastSquaresPolicy(AsymmetricSACPolicy):
    """SB3's policy with `ActionValues` for critics; ``crossed`` of the numbers that the actor sees, the last ones, are told to them."""

    def __init__(self, *args: Any, seen: int, modes: int, crossed: int, low: int = MODES, **kwargs: Any) -> None:
        self._told = {"low": low, "modes": modes, "told": seen - crossed, "crossed": crossed}
        super().__init__(*args, seen=seen, **kwargs)

    def make_critic(self, features_extractor: BaseFeaturesExtractor | None = None) -> Any:
        """In closed form."""
        width, actions = (int(np.prod(space.shape or ())) for space in (self.observation_space, self.action_space))
        return ActionValues(width, actions, **self._told)


class LeastSquaresSAC(SAC):
    """SB3's algorithm, the descent of its critics replaced by ``fit``; ``samples`` of what is remembered are fitted to."""

    samples = 16_384
    memory = 0.9
    ridge = 1e-4

    def fit(self) -> None:
        """The critic of the actor as it is: Σ φ (φ − γ φ⁺)ᵀ w = Σ φ r, φ⁺ with the most likely next action and without a load.

        A white load's next value says nothing of the action before it, and what is left out of φ⁺ is its noise.
        """
        before, after, actions, rewards = self._remembered()
        critic: Any = self.critic
        with torch.no_grad():
            features = critic.features(before, actions)
            after[:, -2:] = 0.0
            following = critic.features(after, self.actor(after, deterministic=True))
            differences = features - self.gamma * following
            latest = torch.cat([features.T @ differences, (rewards @ features)[None], (features**2).sum(dim=0)[None]]).double() / len(rewards)
            self.sums = latest if self.sums is None else self.sums + (1.0 - self.memory) * (latest - self.sums)
            solved = torch.linalg.solve(self.sums[:-2] + torch.diag(self.ridge * self.sums[-1] + 1e-12), self.sums[-2])
            if torch.isfinite(solved).all():  # else that of before
                critic.quadratic.weight[...] = solved.float()
                critic.bend(actions.shape[1])
        errors = differences @ critic.quadratic.weight - rewards
        self.logger.record("train/critic_loss", float((errors**2).mean()))

    sums: Tensor | None = None

    def _remembered(self) -> list[Tensor]:
        """Observations before and after, actions and rewards of ``samples`` that did not end an episode."""
        memory: Any = self.replay_buffer
        rows = np.flatnonzero(memory.dones[: memory.size()].reshape(-1) == 0.0)
        rows = np.random.choice(rows, min(self.samples, len(rows)), replace=False)  # noqa: NPY002 - SB3's own generator
        places, blades = np.divmod(rows, memory.n_envs)
        arrays = memory.observations, memory.next_observations, memory.actions, memory.rewards
        return [torch.as_tensor(array[places, blades]) for array in arrays]

    def train(self, gradient_steps: int, batch_size: int = 64) -> None:
        """Steps of the temperature and of the actor."""
        self._update_learning_rate([self.actor.optimizer, self.ent_coef_optimizer])
        memory: Any = self.replay_buffer
        for _ in range(gradient_steps):
            observations = memory.sample(batch_size).observations
            actions, likelihood = self.actor.action_log_prob(observations)
            if self.log_ent_coef.requires_grad:
                loss = -(self.log_ent_coef * (likelihood + self.target_entropy).detach()).mean()
                self.ent_coef_optimizer.zero_grad()
                loss.backward()
                self.ent_coef_optimizer.step()
            temperature = self.log_ent_coef.detach().exp()
            (value,) = self.critic(observations, actions)
            actor_loss = (temperature * likelihood[:, None] - value).mean()
            self.actor.optimizer.zero_grad()
            actor_loss.backward()
            self.actor.optimizer.step()
        self._n_updates += gradient_steps
        self.logger.record("train/ent_coef", float(temperature))
        self.logger.record("train/actor_loss", float(actor_loss.detach()))
