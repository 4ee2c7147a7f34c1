"""Training through the plant that can be interrupted and gone on from, bit for bit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch

from beamenv.task import Task
from train.controllers.policies import Policy
from train.learning.through_plant.gradient import GradientSettings, GradientTraining
from train.learning.through_plant.snapshot import put, take


class ResumableGradientTraining(GradientTraining):
    """``GradientTraining`` as a ``train.learning.training.Training``."""

    def __init__(self, tasks: Sequence[Task], settings: GradientSettings, seed: int, teacher: Policy | None = None) -> None:
        if teacher is not None:
            raise ValueError("agent = 'gradient' must start from scratch: only ppo, sac and tqc start from a teacher.")
        super().__init__(tasks, settings, seed)
        self.losses: dict[str, float] = {}

    def state(self) -> dict[str, Any]:
        """Weights, optimiser, generator, counters, and the episodes under way."""
        return {
            "actor": self.actor.state_dict(),
            "optimiser": self._optimiser.state_dict(),
            "generator": self._generator.bit_generator.state,
            "windows": [take(windows) for windows in self._windows],
            "counters": {"order": self._order, "steps": self.steps, "updates": self.updates, "cost": torch.as_tensor(self.cost)},
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from ``state``."""
        self.actor.load_state_dict(state["actor"])
        self._optimiser.load_state_dict(state["optimiser"])
        self._generator.bit_generator.state = state["generator"]
        for windows, saved in zip(self._windows, state["windows"], strict=True):
            put(windows, saved)
        counters = state["counters"]
        self._order, self.steps, self.updates = list(counters["order"]), counters["steps"], counters["updates"]
        self.cost = counters["cost"].numpy()

    def close(self) -> None:
        """Nothing is open."""
