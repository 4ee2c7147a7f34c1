"""Episodes unrolled in torch, window after window, on the very kernel and electronics that the environment steps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Protocol

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from beamenv.plant.plant import normalised
from beamenv.simulation.blades import Blades
from beamenv.simulation.kernel import advance
from beamenv.simulation.signals.disturbances import SharedDisturbances
from beamenv.simulation.signals.electronics import Electronics
from beamenv.simulation.signals.faults import SignalMemory, acquire, drive
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
        self._device = device or torch.device("cpu")
        self.length = min(window, task.steps)
        self.count = task.steps // self.length
        self._generator = generator
        self._blades = Blades(task.bank, task.scenario, episodes)
        self._operators = task.bank.operators.convert(self._float)
        self._moving = task.bank.runs or task.bank.walk is not None  # blades come to other plants within an episode
        self._sensors, self._energetic = len(task.plant.C), task.bank.plant.blade_states
        self._phase: NDArray[np.int64] = np.arange(episodes) % self.count
        self._loads = np.zeros((*self._blades.shape, task.plant.disturbance_input.shape[1]))
        self._limits = self._float(normalised(task.plant).voltage_limits)
        self._memory: Memory | None = None
        self._signals: SignalMemory | None = None
        first = self._blades.begin(generator)
        self._state, self._readings = self._float(self._blades.moving), self._float(first.observation)
        self._remember_signals(np.arange(episodes))

    def _begin(self, rows: NDArray[np.int64], actor: Acting) -> None:
        if not len(rows):
            return
        first = self._blades.begin(self._generator, rows)
        self._state[rows] = self._float(self._blades.moving[rows])
        self._readings[rows] = self._float(first.observation)
        self._remember_signals(rows)
        assert self._memory is not None
        for part, fresh in zip(self._memory, actor.start(len(rows)), strict=True):
            part[rows] = fresh

    def _remember_signals(self, rows: NDArray[np.int64]) -> None:
        electronics = self._blades.electronics
        if electronics is None:
            return
        fresh = SignalMemory(*(self._float(part) for part in electronics.memory))
        if self._signals is None:
            self._signals = fresh
        for part, begun in zip(self._signals, fresh, strict=True):
            part[rows] = begun[rows]
        self._convert_faults(electronics)
        self._hysteresis = None if electronics.hysteresis is None else electronics.hysteresis.convert(self._float)

    def _convert_faults(self, electronics: Electronics) -> None:
        self._faults = electronics.faults.convert(lambda part: self._float(part) if part.dtype.kind == "f" else self._whole(part))

    def state_dict(self) -> dict[str, Any]:
        """Copies of what moves, before the next window; the generator is the caller's."""
        return {
            "phase": self._phase.copy(),
            "state": self._state.clone(),
            "readings": self._readings.clone(),
            "memory": None if self._memory is None else [part.clone() for part in self._memory],
            "signals": None if self._signals is None else [part.clone() for part in self._signals],
            "blades": self._blades.state_dict(),
        }

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of equally made windows."""
        self._phase = np.asarray(state["phase"]).copy()
        memory, signals = state["memory"], state["signals"]
        self._state, self._readings = self._copies((state["state"], state["readings"]))
        self._memory = None if memory is None else tuple(self._copies(memory))
        self._signals = None if signals is None else SignalMemory(*self._copies(signals))
        self._blades.load_state_dict(state["blades"])
        if self._blades.electronics is not None:
            self._convert_faults(self._blades.electronics)

    def _disturbances(self) -> Iterator[tuple[Tensor, Tensor]]:
        """Line loads (B, k) and what disturbs the readings (B, c), step by step through this window."""
        batch, disturbances = len(self._phase), self._blades.disturbances
        assert isinstance(disturbances, SharedDisturbances)  # one generator serves the batch
        for _ in range(self.length):
            disturbances.loads(self._loads)
            if (own := self._blades.own_loads) is not None:
                own.add(self._loads)
                own.elapse()
            loads = self._float(self._loads.reshape(batch, -1))
            yield loads, self._float(disturbances.next(self._generator).reshape(batch, -1))

    def unroll(self, actor: Acting) -> tuple[Tensor, Tensor]:
        """Cost (B,) of a window in J s and energy (B,) left at its end in J; differentiable in the actor's weights."""
        actor.limits = self._limits
        if self._memory is None:
            self._memory = actor.start(len(self._phase))
        state, readings, memory, signals = self._state, self._readings, self._memory, self._signals
        cost, operators = torch.zeros(len(state), device=self._device), self._now()
        for loads, disturbance in self._disturbances():
            voltages, memory = actor(readings, memory)
            acting = voltages
            if signals is not None:
                acting, signals = drive(self._faults, self._hysteresis, signals, voltages)
            state, output, _, increment = advance(operators, torch.cat([state, acting, loads], dim=1))
            state = self._elapse(state)
            operators = self._now() if self._moving else operators
            readings, signals = self._read(output, disturbance, signals)
            cost = cost + increment
        left = 0.5 * (state[:, : self._energetic] ** 2).sum(dim=1)
        self._keep(state, readings, memory, signals)
        self._phase = (self._phase + 1) % self.count
        self._begin(np.flatnonzero(self._phase == 0), actor)
        return cost, left

    def _elapse(self, state: Tensor) -> Tensor:
        """One control interval later: other plants may be on, to whose coordinates states go over, and other faults at work."""
        passage = self._blades.elapse()
        electronics = self._blades.electronics
        if electronics is not None and electronics.changing:
            self._convert_faults(electronics)
        if passage is None:
            return state
        rows = self._whole(passage.rows)
        return state.index_copy(0, rows, (state[rows, None] @ self._float(passage.change))[:, 0])

    def _now(self) -> Any:
        index = self._blades.index
        if len(self._blades.bank) == 1:
            return self._operators
        return self._operators.pick(self._whole(index))

    def _read(self, output: Tensor, disturbance: Tensor, signals: SignalMemory | None) -> tuple[Tensor, SignalMemory | None]:
        noise = disturbance[:, : self._sensors]
        if signals is None:
            return torch.clamp(output + noise, -1.0, 1.0), None
        electronics = self._blades.electronics
        assert electronics is not None
        lost = None
        if electronics.threshold is not None:
            lost = disturbance[:, self._sensors : 2 * self._sensors] < electronics.threshold
        return acquire(self._faults, signals, output, noise, lost)

    def _keep(self, state: Tensor, readings: Tensor, memory: Memory, signals: SignalMemory | None) -> None:
        self._state, self._readings = state.detach().clone(), readings.detach().clone()
        self._memory = tuple(part.detach().clone() for part in memory)
        self._signals = None if signals is None else SignalMemory(*(part.detach().clone() for part in signals))

    def _copies(self, parts: Iterable[Tensor]) -> list[Tensor]:
        return [part.to(self._device, copy=True) for part in parts]

    def _float(self, array: Any) -> Tensor:
        return torch.tensor(np.ascontiguousarray(array), dtype=torch.float32, device=self._device)  # a copy: plants are read-only

    def _whole(self, array: Any) -> Tensor:
        return torch.as_tensor(array, device=self._device)
