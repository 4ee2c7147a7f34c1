"""Behaviour cloning: a network on the history learns to do as a teacher does, on the way to being tuned.

Dataset aggregation (Ross, Gordon and Bagnell 2011): after a first share of the steps the student drives, and the teacher says what
it would have done where the student has got to.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from beamenv.configuration import Refused
from train.controllers.policies import Policy
from train.learning.sb3.side_by_side import SideBySide
from train.learning.sb3.vec_env import TrainingVecEnv

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class Cloning:
    """How a teacher is cloned."""

    actions: int = 1000
    """Of every blade: two seconds of 2 ms each, four episodes."""
    taught: float = 0.25
    """Share of them in which the teacher drives."""
    samples: int = 200_000
    """Remembered, the latest ones."""
    batch: int = 2048
    gradient_steps: int = 4
    """After each action."""
    learning_rate: float = 2e-3
    """Adam's, falling linearly to zero."""


class Follower:
    """A teacher that reads along in windows: it is shown each instant and the voltages that really were held before it."""

    def __init__(self, teacher: Policy, count: int, instants: int, held: int) -> None:
        self._teacher, self._shape, self._held = teacher, (count, instants, -1), held
        self._memory = np.zeros((count, teacher.memory_size), np.float32)

    def follow(self, windows: Array, begun: NDArray[np.bool_]) -> Array:
        """(N, m): what the teacher would do now, having seen the last windows (N, …); ``begun`` are rows in their first instant."""
        voltages = len(self._teacher.lowest)
        instants = windows.reshape(self._shape)[:, -self._held :]
        self._memory[begun] = 0.0
        action = np.zeros((len(windows), voltages), np.float32)
        for k in range(self._held):
            at = np.full(len(windows), True) if k == self._held - 1 else ~begun
            readings, before = instants[at, k, :-voltages], instants[at, k, -voltages:]
            memory = self._teacher.knowing(self._memory[at], before)
            action[at], self._memory[at] = self._teacher.predict(readings, memory)
        return action


def check_clonable(settings: Any) -> None:
    """``ValueError`` for a student that a teacher's voltages tell nothing: it must see a history, and act at once."""
    for name, only in (("sees", "history"), ("approach", 1.0)):
        if getattr(settings, name) != only:
            raise Refused(f"settings.{name}", getattr(settings, name), f"{only!r} where a teacher is given")


def clone(
    student: nn.Module, envs: TrainingVecEnv | SideBySide, teacher: Policy, gain: float, cloning: Cloning, seed: int
) -> list[float]:
    """Train ``student``, from ``gain`` times a window to an action, to do as the teacher; the mean squared errors on the way."""
    generator = np.random.default_rng(seed)
    optimiser = torch.optim.Adam(student.parameters(), lr=cloning.learning_rate)
    voltages = len(teacher.lowest)
    instants = _instants(envs, voltages)
    follower = Follower(teacher, envs.num_envs, instants, envs.held)
    memory, labels = np.zeros((cloning.samples, envs.seen), np.float32), np.zeros((cloning.samples, voltages), np.float32)
    windows, begun, errors = envs.reset()[:, : envs.seen], np.ones(envs.num_envs, dtype=np.bool_), []
    for step in range(cloning.actions):
        wanted = follower.follow(windows, begun)
        places = (step * len(windows) + np.arange(len(windows))) % cloning.samples
        memory[places], labels[places] = windows, wanted
        own = _act(student, gain * windows)
        envs.step_async(wanted if step < cloning.taught * cloning.actions else own)
        observations, _, begun, _ = envs.step_wait()
        windows = observations[:, : envs.seen]
        for group in optimiser.param_groups:
            group["lr"] = cloning.learning_rate * (1.0 - step / cloning.actions)
        known = min((step + 1) * len(windows), cloning.samples)
        for _ in range(cloning.gradient_steps):
            rows = generator.integers(known, size=cloning.batch)
            errors.append(_learn(student, optimiser, gain * memory[rows], labels[rows]))
    return errors


def _instants(envs: TrainingVecEnv | SideBySide, voltages: int) -> int:
    """In a window; ``ValueError`` unless it shows all since the last action."""
    batch = envs.batches[0] if isinstance(envs, SideBySide) else envs
    instants = batch.seen // (len(batch.blades.plant.C) + voltages)
    if instants < envs.held:
        raise ValueError(f"history = {instants} must be at least held = {envs.held} for a teacher to follow.")
    return instants


def _act(student: nn.Module, inputs: Array) -> Array:
    with torch.no_grad():
        action: Array = student(torch.as_tensor(inputs)).clamp(-1.0, 1.0).numpy()
    return action


def _learn(student: nn.Module, optimiser: torch.optim.Optimizer, inputs: Array, labels: Array) -> float:
    error = nn.functional.mse_loss(student(torch.as_tensor(inputs)), torch.as_tensor(labels))
    optimiser.zero_grad()
    error.backward()  # type: ignore[no-untyped-call]
    optimiser.step()
    return float(error.detach())
