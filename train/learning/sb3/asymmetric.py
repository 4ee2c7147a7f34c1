"""An actor that sees what sensors show and critics that see the true state: critics are not needed once training is over.

Asymmetric actor-critic (Pinto et al. 2017). The observation is [what the actor sees | what only the critic sees].
"""

from __future__ import annotations

from typing import Any

from gymnasium.spaces import Space
from sb3_contrib.common.recurrent.policies import RecurrentActorCriticPolicy
from sb3_contrib.tqc.policies import TQCPolicy
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor
from stable_baselines3.sac.policies import SACPolicy
from torch import Tensor, nn


class Part(BaseFeaturesExtractor):
    """The numbers of an observation from ``begin`` to ``end``, times a gain."""

    def __init__(self, observation_space: Space[Any], begin: int, end: int, gain: float = 1.0) -> None:
        super().__init__(observation_space, features_dim=end - begin)
        self.begin, self.end, self.gain = begin, end, gain

    def forward(self, observations: Tensor) -> Tensor:
        """(B, end − begin)."""
        return self.gain * observations[:, self.begin : self.end]


class AsymmetricNetworks(nn.Module):
    """Two networks on the two parts of the observation: tanh layers, or nothing at all before the output of a linear actor."""

    def __init__(self, seen: int, hidden: int, actor_gain: float, units: int, linear: bool = False) -> None:
        super().__init__()
        self.seen, self.actor_gain = seen, actor_gain
        self.policy_net = nn.Sequential() if linear else tanh_layers(seen, units)
        self.value_net = tanh_layers(hidden, units)
        self.latent_dim_pi, self.latent_dim_vf = seen if linear else units, units

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

    def __init__(self, *args: Any, seen: int, actor_gain: float, units: int, linear: bool = False, **kwargs: Any) -> None:
        self._networks = {"seen": seen, "actor_gain": actor_gain, "units": units, "linear": linear}
        super().__init__(*args, **kwargs)
        if linear:  # it begins without voltages
            assert isinstance(self.action_net, nn.Linear)
            nn.init.zeros_(self.action_net.weight)

    def _build_mlp_extractor(self) -> None:
        seen = int(self._networks["seen"])
        self.mlp_extractor = AsymmetricNetworks(hidden=self.features_dim - seen, **self._networks)  # type: ignore[assignment, arg-type]


class AsymmetricRecurrentPolicy(RecurrentActorCriticPolicy):
    """sb3-contrib's policy: an LSTM and one linear layer act on what is seen; a tanh network values the true state."""

    def __init__(self, *args: Any, seen: int, actor_gain: float, units: int, **kwargs: Any) -> None:
        kwargs |= {"share_features_extractor": False, "enable_critic_lstm": False, "lstm_hidden_size": units}
        kwargs |= {"features_extractor_class": Part, "net_arch": {"pi": [], "vf": [units]}}
        kwargs |= {"features_extractor_kwargs": {"begin": 0, "end": seen, "gain": actor_gain}}
        super().__init__(*args, **kwargs)
        width = int(self.observation_space.shape[0])  # type: ignore[index]
        self.vf_features_extractor = Part(self.observation_space, seen, width)
        self.critic = nn.Sequential(nn.Linear(width - seen, units), nn.Tanh())  # type: ignore[assignment]
        optimiser: Any = self.optimizer_class
        self.optimizer = optimiser(self.parameters(), lr=self.optimizer.defaults["lr"], **self.optimizer_kwargs)


class _Apart:
    """Of a policy with critics of actions: the actor on what is seen, the critics on the true state."""

    observation_space: Space[Any]

    def __init__(self, *args: Any, seen: int, actor_gain: float, **kwargs: Any) -> None:
        self._seen, self._actor_gain = seen, actor_gain
        super().__init__(*args, **kwargs)

    def make_actor(self, features_extractor: BaseFeaturesExtractor | None = None) -> Any:
        """With the part it sees."""
        policy: Any = super()
        return policy.make_actor(Part(self.observation_space, 0, self._seen, self._actor_gain))

    def make_critic(self, features_extractor: BaseFeaturesExtractor | None = None) -> Any:
        """With the part that is hidden from the actor."""
        policy: Any = super()
        width = int(self.observation_space.shape[0])  # type: ignore[index]
        return policy.make_critic(Part(self.observation_space, self._seen, width))


class AsymmetricSACPolicy(_Apart, SACPolicy):
    """SB3's policy, actor and critics apart."""


class AsymmetricTQCPolicy(_Apart, TQCPolicy):
    """sb3-contrib's policy, actor and critics apart."""


def tanh_layers(inputs: int, units: int) -> nn.Sequential:
    """Two hidden layers."""
    return nn.Sequential(nn.Linear(inputs, units), nn.Tanh(), nn.Linear(units, units), nn.Tanh())
