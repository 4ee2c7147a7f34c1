"""Soft actor-critic whose critic is fitted in closed form: least squares on temporal differences, from what is remembered.

Of a linear plant under a linear law Q is quadratic in the true state, the load, the belief, the voltages and the action
(Bradtke, Ydstie and Barto 1994). Least squares find the fixed point of Bellman's equation in these features without target
networks and without rates (Bradtke and Barto 1996; Lagoudakis and Parr 2003). The actor, its entropy and its temperature are those
of Stable-Baselines3.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from stable_baselines3 import SAC
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor
from torch import Tensor, nn

from train.learning.sb3.asymmetric import AsymmetricSACPolicy
from train.learning.sb3.quadratic import RIDGE, Quadratic

SLOW = 12
"""Modes whose products with actions, and with each other, are features: what is left out of these is noise."""


class ActionValues(nn.Module):
    """Q = φᵀw of `Quadratic` features of [action | what ``told`` begins: belief, voltages held, true state, loads (2)]."""

    sums: Tensor
    """Of φ (φ − γ φ⁺)ᵀ, and, last rows, of φ r and of φ²; kept with the weights, to resume from."""

    def __init__(self, width: int, actions: int, modes: int, told: int, crossed: int) -> None:
        super().__init__()
        self.told, self._actions = told, actions
        self.quadratic = Quadratic(actions + width - told, modes, actions + crossed, slow=SLOW)
        count = len(self.quadratic.weight)
        self.register_buffer("sums", torch.zeros(count + 2, count, dtype=torch.float64))

    def features(self, observations: Tensor, actions: Tensor) -> Tensor:
        """(B, k)."""
        return self.quadratic.features(torch.cat([actions, observations[:, self.told :]], dim=1))

    def forward(self, observations: Tensor, actions: Tensor) -> tuple[Tensor, ...]:
        """(B, 1), of the only critic."""
        return (self.quadratic(torch.cat([actions, observations[:, self.told :]], dim=1)),)

    def set_training_mode(self, mode: bool) -> None:
        """Nothing depends on it."""

    def solve(self, latest: Tensor, memory: float) -> None:
        """Weights by ``latest`` sums, if they are finite, and, fading by ``memory``, those before."""
        if not torch.isfinite(latest).all():
            return
        self.sums += latest if not self.sums.any() else (1.0 - memory) * (latest - self.sums)
        matrix, right, squares = self.sums[:-2], self.sums[-2], self.sums[-1]
        solved = torch.linalg.solve(matrix + torch.diag(RIDGE * squares + 1e-12), right)
        if torch.isfinite(solved).all():  # else those of before
            self.quadratic.weight[...] = solved.float()
            self._bend()

    def _bend(self) -> None:
        """Take away what curves upwards in the action: no cost does."""
        first, second, own = self.quadratic.first, self.quadratic.second, self._actions
        places = torch.nonzero((first < own) & (second < own))[:, 0]
        curvature = torch.zeros(own, own)
        curvature[first[places], second[places]] = self.quadratic.weight[places]
        values, vectors = torch.linalg.eigh((curvature + curvature.T) / 2.0)
        bent = (vectors * values.clamp(max=0.0)) @ vectors.T
        self.quadratic.weight[places] = (2.0 * bent - torch.diag(torch.diag(bent)))[first[places], second[places]]


class LeastSquaresPolicy(AsymmetricSACPolicy):
    """SB3's policy with `ActionValues` for critics, which are told the last ``crossed`` numbers that the actor sees."""

    def __init__(self, *args: Any, seen: int, modes: int, crossed: int, **kwargs: Any) -> None:
        self._told = {"modes": modes, "told": seen - crossed, "crossed": crossed}
        super().__init__(*args, seen=seen, **kwargs)

    def make_critic(self, features_extractor: BaseFeaturesExtractor | None = None) -> Any:
        """In closed form."""
        width, actions = (int(np.prod(space.shape or ())) for space in (self.observation_space, self.action_space))
        return ActionValues(width, actions, **self._told)


class LeastSquaresSAC(SAC):
    """SB3's algorithm with ``fit`` in the place of its critics' descent."""

    def fit(self, samples: int, memory: float) -> None:
        """The critic of the actor as it is: Σ φ (φ − γ φ⁺)ᵀ w = Σ φ r over ``samples`` of what is remembered.

        φ⁺ is of the most likely next action, and without a load: the white load of the next interval says nothing of this action,
        and shown there it would be nearly all of the differences' noise.
        """
        before, after, actions, rewards = self._remembered(samples)
        critic: Any = self.critic
        after[:, -2:] = 0.0
        with torch.no_grad():
            features = critic.features(before, actions)
            differences = features - self.gamma * critic.features(after, self.actor(after, deterministic=True))
            parts = features.T @ differences, (rewards @ features)[None], (features**2).sum(dim=0)[None]
            critic.solve(torch.cat(parts).double() / len(rewards), memory)
            errors = differences @ critic.quadratic.weight - rewards
        self.logger.record("train/critic_loss", float((errors**2).mean()))

    def _remembered(self, samples: int) -> list[Tensor]:
        """Observations before and after, actions and rewards, (B, …) each, of what did not end an episode."""
        memory: Any = self.replay_buffer
        rows = np.flatnonzero(memory.dones[: memory.size()].reshape(-1) == 0.0)
        rows = np.random.choice(rows, min(samples, len(rows)), replace=False)  # noqa: NPY002 - SB3's own generator
        places, blades = np.divmod(rows, memory.n_envs)
        arrays = memory.observations, memory.next_observations, memory.actions, memory.rewards
        return [torch.as_tensor(array[places, blades]) for array in arrays]

    def train(self, gradient_steps: int, batch_size: int = 64) -> None:
        """Steps of the temperature and of the actor, as SB3 has them."""
        entropy: Any = self.ent_coef_optimizer
        weight: Any = self.log_ent_coef
        memory: Any = self.replay_buffer
        critic: Any = self.critic
        wanted = float(self.target_entropy)
        self._update_learning_rate([self.actor.optimizer, entropy])
        for _ in range(gradient_steps):
            observations = memory.sample(batch_size).observations
            actions, likelihood = self.actor.action_log_prob(observations)
            temperature = weight.detach().exp()
            _descend(entropy, -(weight * (likelihood + wanted).detach()).mean())
            (values,) = critic(observations, actions)
            loss = (temperature * likelihood[:, None] - values).mean()
            _descend(self.actor.optimizer, loss)
            self.logger.record("train/ent_coef", float(temperature))
            self.logger.record("train/actor_loss", float(loss.detach()))
        self._n_updates += gradient_steps


def _descend(optimiser: torch.optim.Optimizer, loss: Tensor) -> None:
    optimiser.zero_grad()
    loss.backward()  # type: ignore[no-untyped-call]
    optimiser.step()
