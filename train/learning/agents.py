"""The trainers by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from beamenv.task import Task
from train.controllers.policies import Policy
from train.learning.sb3.off_policy import OffPolicySettings, SACTraining, TQCTraining
from train.learning.sb3.ppo import PPOSettings, PPOTraining
from train.learning.sb3.recurrent_ppo import RecurrentPPOSettings, RecurrentPPOTraining
from train.learning.through_plant.gradient import GradientSettings, GradientTraining
from train.learning.training import Training


@dataclass(frozen=True, slots=True)
class Agent:
    """A trainer."""

    settings: Callable[[], Any]
    """Its dataclass of settings."""
    training: Callable[[Sequence[Task], Any, int, Policy | None], Training]
    """From tasks, settings, seed and, for those that can start from one, a teacher."""


AGENTS: Mapping[str, Agent] = MappingProxyType(
    {
        "gradient": Agent(GradientSettings, GradientTraining),
        "ppo": Agent(PPOSettings, PPOTraining),
        "sac": Agent(OffPolicySettings, SACTraining),
        "tqc": Agent(OffPolicySettings, TQCTraining),
        "recurrent-ppo": Agent(RecurrentPPOSettings, RecurrentPPOTraining),
    }
)
"""By short name. All meet the true blade, whose plants come from a bank of their own."""
