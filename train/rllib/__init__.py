"""The door for users of Ray RLlib: blades for its env runners, a network, and PPO's settings as they were found to learn.

RLlib is not among the extras: ``pip install 'ray[rllib]>=2.54'`` beside ``beamenv[train]``.
"""

from train.rllib.blades import ENVIRONMENT, Blade, Blades, register
from train.rllib.network import LinearOnBelief
from train.rllib.ppo import policy_of, ppo_config

__all__ = ["ENVIRONMENT", "Blade", "Blades", "LinearOnBelief", "policy_of", "ppo_config", "register"]
