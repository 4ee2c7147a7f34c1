"""What the trainers share: what a training is, how it reports, and the cost it is measured by."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from beamenv.knowledge import on_training_bank as training_scenario
from beamenv.simulation.blades import Blades
from beamenv.task import Task
from train.controllers.policies import Policy


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a training is."""

    elapsed: float
    """s."""
    steps: int
    """Environment steps so far."""
    cost: float
    """J relative to no control, from recent training episodes."""
    updates: int = 0
    """Updates of the policy so far."""
    costs: tuple[float, ...] = ()
    """``cost`` of each of the runs side by side, of which it is the mean."""
    validated: float = math.nan
    """J relative to no control without exploration, on validation seeds; NaN unless a look at the policy followed this update."""
    looked: tuple[float, ...] = ()
    """The same of each run where the training itself does not look: nothing is chosen by it. Empty unless one followed."""


Report = Callable[[Progress], None]


class Training(Protocol):
    """A training, update by update. Equal arguments and equal calls make equal policies, bit for bit on one thread."""

    steps: int
    """Control intervals so far."""
    updates: int
    cost: Any
    """J relative to no control, recently: a number, or one for each policy."""
    validated: float
    """As ``Progress`` has it."""
    losses: dict[str, float]
    """Of the last update, by name."""

    def update(self, remaining: float) -> None:
        """One update; ``remaining``, from 1 to 0, is the share of the training still to come: learning rates fall with it."""

    def policies(self) -> list[Policy]:
        """What has been learnt so far: one policy, or those of several runs side by side."""

    def state_dict(self) -> dict[str, Any]:
        """Numbers, strings, lists, dictionaries, arrays and tensors that ``load_state_dict`` resumes from."""

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Resume from the ``state_dict`` of an equally made training."""

    def close(self) -> None:
        """Let go of the environments."""


def on_training_bank(task: Task) -> Task:
    """The task with plants drawn from another bank than the one that controllers are judged on."""
    return task.on_other_plants(training_scenario(task.scenario))


def uncontrolled_cost(task: Task, episodes: int = 512) -> float:
    """Mean J (J s) of episodes without control: what running costs are relative to. ``ValueError`` if there is none to reduce."""
    blades, generator = Blades(task.bank, task.scenario, episodes), np.random.default_rng(0)
    blades.begin(generator)
    idle = np.zeros((episodes, task.plant.B.shape[1]))
    cost = float(sum(blades.step(idle, generator).cost_increment.mean() for _ in range(task.steps)))
    if not cost > 0.0:
        raise ValueError("scenario leaves the blade at rest: there is nothing to learn in it.")
    return cost
