"""Episodes unrolled in torch, window after window: a loop over the very blades that the environments step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from beamenv.arrays import Arrays
from beamenv.plant.plant import normalised
from beamenv.simulation.blades import Blades
from beamenv.task import Task

Memory = tuple[Tensor, ...]


class Acting(Protocol):
    """A policy in torch."""

    limits: Tensor
    """(2, m): what the drive lets through, in units of the larger limit."""

    def start(self, count: int) -> Memory:
        """What it remembers at the start of ``count`` episodes; the last part holds the voltages (count, m)."""
        ...

    def __call__(self, readings: Tensor, memory: Memory) -> tuple[Tensor, Memory]:
        """Voltages (B, m) as the drive lets them through, and the next memory, from readings (B, p)."""
        ...


class Windows:
    """A batch of episodes of one task, cut into windows unrolled one after the other; blades are spread over the windows."""

    def __init__(
        self, task: Task, episodes: int, window: int, generator: np.random.Generator, device: torch.device | None = None
    ) -> None:
        self._arrays = Arrays("float32", str(device or "cpu"))
        self.length = min(window, task.steps)
        self.count = task.steps // self.length
        self._generator = generator
        self._blades = Blades(task.bank, task.scenario, episodes, arrays=self._arrays)
        self._phase: NDArray[np.int64] = np.arange(episodes) % self.count
        self._limits: Tensor = self._arrays.floats(normalised(task.plant).voltage_limits)
        self._memory: Memory | None = None
        self._readings: Tensor = self._blades.begin(generator).observation

    def _begin(self, rows: NDArray[np.int64], actor: Acting) -> None:
        if not len(rows):
            return
        self._readings[rows] = self._blades.begin(self._generator, self._arrays.exact(rows)).observation
        assert self._memory is not None
        for part, fresh in zip(self._memory, actor.start(len(rows)), strict=True):
            part[rows] = fresh

    def state_dict(self) -> dict[str, Any]:
        """Copies of what moves, before the next window; the generator is the caller's."""
        return {
            "phase": self._phase.copy(),
            "readings": self._readings.clone(),
            "memory": None if self._memory is None else [part.clone() for part in self._memory],
            "blades": self._blades.state_dict(),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of equally made windows."""
        self._phase = np.asarray(state["phase"]).copy()
        memory, device = state["memory"], self._readings.device
        self._readings = state["readings"].to(device, copy=True)
        self._memory = None if memory is None else tuple(part.to(device, copy=True) for part in memory)
        self._blades.load_state_dict(state["blades"])

    def unroll(self, actor: Acting) -> tuple[Tensor, Tensor]:
        """Cost (B,) of a window in J s and energy (B,) left at its end in J; differentiable in the actor's weights."""
        actor.limits = self._limits
        memory = actor.start(len(self._phase)) if self._memory is None else self._memory
        readings, increments = self._readings, []
        for _ in range(self.length):
            voltages, memory = actor(readings, memory)
            motion = self._blades.step(voltages, self._generator)
            readings = motion.observation
            increments.append(motion.cost_increment)
        self._blades.detach()
        self._readings, self._memory = readings.detach().clone(), tuple(part.detach().clone() for part in memory)
        self._phase = (self._phase + 1) % self.count
        self._begin(np.flatnonzero(self._phase == 0), actor)
        return torch.stack(increments).sum(0), motion.energy
