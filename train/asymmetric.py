"""An actor that sees what sensors show and a critic that sees the true state: the critic is not needed once training is over.

Asymmetric actor-critic (Pinto et al. 2017). The observation is [what the actor sees | what only the critic sees].
"""

from __future__ import annotations

from typing import Any

from stable_baselines3.common.policies import ActorCriticPolicy
from torch import Tensor, nn


class AsymmetricNetworks(nn.Module):
    """Two tanh networks on the two parts of the observation."""

    def __init__(self, seen: int, hidden: int, actor_gain: float, units: int) -> None:
        super().__init__()
        self.seen, self.actor_gain = seen, actor_gain
        self.policy_net, self.value_net = tanh_layers(seen, units), tanh_layers(hidden, units)
        self.latent_dim_pi = self.latent_dim_vf = units

    def forward(self, features: Tensor) -> tuple[Tensor, Tensor]:
        """Latent of the actor and of the critic."""
        return self.forward_actor(features), self.forward_critic(features)

    def forward_actor(self, features: Tensor) -> Tensor:
        """From what sensors show."""
        latent: Tensor = self.policy_net(self.actor_gain * features[:, : self.seen])
        return latent

    def forward_critic(self, features: Tensor) -> Tensor:
        """From the true state."""
        latent: Tensor = self.value_net(features[:, self.seen :])
        return latent


class AsymmetricPolicy(ActorCriticPolicy):
    """SB3's policy with `AsymmetricNetworks`."""

    def __init__(self, *args: Any, seen: int, actor_gain: float, units: int, **kwargs: Any) -> None:
        self._networks = {"seen": seen, "actor_gain": actor_gain, "units": units}
        super().__init__(*args, **kwargs)

    def _build_mlp_extractor(self) -> None:
        seen = int(self._networks["seen"])
        self.mlp_extractor = AsymmetricNetworks(hidden=self.features_dim - seen, **self._networks)  # type: ignore[assignment, arg-type]


def tanh_layers(inputs: int, units: int) -> nn.Sequential:
    """Two hidden layers."""
    return nn.Sequential(nn.Linear(inputs, units), nn.Tanh(), nn.Linear(units, units), nn.Tanh())
