"""A critic in closed form: values of a linear plant under a linear law are quadratic in its state, load, belief and voltages.

Least squares fit it to the returns of a rollout before these are learnt from: no rate, no network, no value loss.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.type_aliases import PyTorchObs
from torch import Tensor, nn

from train.learning.sb3.asymmetric import AsymmetricPolicy
from train.learning.sb3.twins import without_the_twin

MODES = 6
"""Of which all products, with each other and with what is seen, are features; of those above, which move little, squares."""

MEMORY = 0.7
"""Share that earlier rollouts keep in the sums of squares."""

RIDGE = 1e-4
"""Of each feature's mean square."""


class Quadratic(nn.Module):
    """V = Σ w_ij s_i s_j + Σ w_k s_k² + w on rows [seen | displacements | velocities | electronics | loads (2)].

    ``seen`` is how many numbers of what the actor sees are in a row: a belief's, which may be wrong, and the voltages held. s_i are
    these, the loads, and the states of so many ``slow`` modes.
    """

    squares: Tensor
    """Sums of features' products, and, last row, of features times returns; kept with the weights, to resume from."""

    def __init__(self, width: int, modes: int, seen: int, slow: int = MODES) -> None:
        super().__init__()
        low = min(slow, modes)
        places = [*range(low), *range(modes, modes + low)]
        crossed = [*range(seen), *(seen + place for place in places), width - 2, width - 1]
        self.crossed, self.alone = crossed, sorted(set(range(width)) - set(crossed))
        self.first, self.second = (torch.as_tensor(each) for each in np.triu_indices(len(crossed)))
        count = len(self.first) + len(self.alone) + 1
        self.weight = nn.Parameter(torch.zeros(count), requires_grad=False)
        self.register_buffer("squares", torch.zeros(count + 1, count, dtype=torch.float64))

    def features(self, states: Tensor) -> Tensor:
        """(B, k)."""
        crossed, alone = states[:, self.crossed], states[:, self.alone]
        return torch.cat([crossed[:, self.first] * crossed[:, self.second], alone**2, torch.ones(len(states), 1)], dim=1)

    def forward(self, states: Tensor) -> Tensor:
        """(B, 1)."""
        return (self.features(states) @ self.weight)[:, None]

    def fit(self, features: Tensor, returns: Tensor) -> None:
        """Ridge regression on ``features`` (B, k) and, fading, on those before."""
        latest = torch.cat([features.T @ features, (returns @ features)[None]]).double() / len(features)
        self.squares += latest if not self.squares.any() else (1.0 - MEMORY) * (latest - self.squares)
        matrix, right = self.squares[:-1], self.squares[-1]
        solved = torch.linalg.solve(matrix + torch.diag(RIDGE * torch.diag(matrix) + 1e-12), right)
        if torch.isfinite(solved).all():  # else that of before
            self.weight[...] = solved.float()


class QuadraticPolicy(AsymmetricPolicy):
    """SB3's policy with an actor of `AsymmetricNetworks` and a `Quadratic` critic of the true state and ``crossed`` numbers."""

    def __init__(self, *args: Any, seen: int, modes: int, crossed: int, **kwargs: Any) -> None:
        super().__init__(*args, seen=seen, **kwargs)
        self.told = seen - crossed
        """Where what the critic is told begins, with the last numbers that the actor sees."""
        self.quadratic = Quadratic(self.features_dim - self.told, modes, crossed)

    def forward(self, obs: Tensor, deterministic: bool = False) -> tuple[Tensor, Tensor, Tensor]:
        """Actions, values and log-probabilities; values are none, as ``FitCritic`` reckons those of a rollout together."""
        distribution = self._get_action_dist_from_latent(self.mlp_extractor.forward_actor(obs))
        actions = distribution.get_actions(deterministic=deterministic)
        return actions, torch.zeros(len(obs), 1), distribution.log_prob(actions)

    def evaluate_actions(self, obs: PyTorchObs, actions: Tensor) -> tuple[Tensor, Tensor, Tensor | None]:
        """No values: none are learnt by descent."""
        assert isinstance(obs, Tensor)
        distribution = self._get_action_dist_from_latent(self.mlp_extractor.forward_actor(obs))
        return torch.zeros(len(obs), 1), distribution.log_prob(actions), distribution.entropy()

    def predict_values(self, obs: PyTorchObs) -> Tensor:
        """(B, 1)."""
        assert isinstance(obs, Tensor)
        values: Tensor = self.quadratic(obs[:, self.told :])
        return values


class FitCritic(BaseCallback):
    """At the end of a rollout fits the critic to its returns, and reckons its advantages anew; with ``twins``, less theirs."""

    def __init__(self, twins: bool = False) -> None:
        super().__init__()
        self._twins = twins

    def _on_step(self) -> bool:
        return True

    def _on_rollout_end(self) -> None:
        model: Any = self.model
        buffer, critic, told = model.rollout_buffer, model.policy.quadratic, model.policy.told
        rows = torch.as_tensor(buffer.observations.reshape(-1, buffer.observations.shape[-1])[:, told:])
        with torch.no_grad():
            features, last = critic.features(rows), critic.features(torch.as_tensor(model._last_obs[:, told:]))
            self._reckon(features, last)
            critic.fit(features, torch.as_tensor(buffer.returns.reshape(-1)))
            self._reckon(features, last)
        if self._twins:
            buffer.advantages[...] = without_the_twin(buffer.advantages, buffer.observations[..., -2:])

    def _reckon(self, features: Tensor, last: Tensor) -> None:
        """Values, advantages and returns by the critic as it is."""
        model: Any = self.model
        buffer, weight = model.rollout_buffer, model.policy.quadratic.weight
        buffer.values[...] = (features @ weight).numpy().reshape(buffer.values.shape)
        buffer.compute_returns_and_advantage(last_values=(last @ weight)[:, None], dones=model._last_episode_starts)
