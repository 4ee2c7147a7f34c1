"""What the trainers share: how they report, and the cost they are measured by."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import torch

from beamenv.simulation import Blades
from beamenv.task import Task


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a training is."""

    elapsed: float
    """s."""
    steps: int
    """Environment steps so far."""
    cost: float
    """J relative to no control, from recent training episodes."""


Report = Callable[[Progress], None]


def uncontrolled_cost(task: Task, episodes: int = 512) -> float:
    """Mean J (J s) of episodes without control: what running costs are relative to."""
    blades, generator = Blades(task.bank, task.scenario, episodes), np.random.default_rng(0)
    blades.begin(generator)
    idle = np.zeros((episodes, task.plant.B.shape[1]))
    return float(sum(blades.step(idle, generator).cost_increment.mean() for _ in range(task.steps)))


@contextmanager
def one_torch_thread() -> Iterator[None]:
    """These networks are so small that threads cost more than they gain, and on a busy machine a hundred times more."""
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(threads)
