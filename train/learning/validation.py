"""How good a policy is without exploration: on plants and seeds of validation, which choose among checkpoints and judge nobody."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.knowledge import on_validation_bank
from beamenv.simulation.blades import Blades
from beamenv.task import Task
from train.controllers.policies import Policy
from train.shared.held_out import VALIDATION

EPISODES = 32
"""Of each task."""

HIGHEST = 100.0
"""J relative to no control, that counts for a blade which shakes itself to pieces."""


class Validation:
    """The same episodes for every policy, of each of some tasks on the plants that choose; their seeds begin with ``first``."""

    def __init__(self, tasks: Sequence[Task], first: int = VALIDATION) -> None:
        self._first = first
        self._tasks = [task.on_other_plants(on_validation_bank(task.scenario)) for task in tasks]

    def cost(self, policy: Policy) -> float:
        """J relative to no control, the mean over the tasks."""
        costs = [_costs(task, policy, self._first) for task in self._tasks]
        relative = [np.minimum(own / alone.mean(), HIGHEST).mean() for own, alone in zip(costs, self._alone, strict=True)]
        return float(np.mean(relative))

    @cached_property
    def _alone(self) -> list[NDArray[np.float64]]:
        return [_costs(task, None, self._first) for task in self._tasks]


def _costs(task: Task, policy: Policy | None, first: int) -> NDArray[np.float64]:
    """(EPISODES,) J in J s; without control for None."""
    blades = Blades(task.bank, task.scenario, EPISODES)
    generators = [np.random.default_rng(first + k) for k in range(EPISODES)]
    readings, memory = blades.begin(generators).observation, None
    action: Any
    action, total = np.zeros((EPISODES, task.plant.B.shape[1])), np.zeros(EPISODES)
    for _ in range(task.steps):
        if policy is not None:
            action, memory = policy.predict(readings, memory)
        motion = blades.step(action, generators)
        readings = motion.observation
        total += motion.cost_increment
    return np.nan_to_num(total, nan=np.inf)
