"""An estimate learnt from readings alone: least squares from oscillators to the slow modes, which a training knows.

A filter that a design gives is not needed: whoever trains in simulation knows the true state, as the critic does, and what
readings and voltages tell of it is a regression (privileged learning; Chen et al. 2020). It is made anew on the way, as a better
policy moves the blade otherwise; what a gain on it means stays, so that the policy stays too.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from beamenv.plant.hold import hold
from beamenv.plant.plant import Plant
from beamenv.task import Task
from train.learning.sb3.belief import OSCILLATOR_DAMPING, Belief
from train.learning.sb3.typical import load_unit, shown_states, typical_state

Array = NDArray[Any]

FREQUENCIES = (6.0, 10.0, 16.0, 25.0, 40.0, 63.0, 100.0)
"""Hz."""

MEMORY = 0.25
"""Share that earlier sums keep at a fit."""

RIDGE = 1e-5
"""Of each number's mean square."""


def two_sided_bank(plant: Plant, modes: int) -> Belief:
    """Oscillators for readings and voltages alike, n of them, of which nothing is shown yet: (n, f) zeros of modes and loads."""
    p, m = len(plant.C), plant.B.shape[1]
    omega = 2.0 * np.pi * np.array(FREQUENCIES) / plant.time_scale
    blocks = [np.array([[-2.0 * OSCILLATOR_DAMPING * w, -w], [w, 0.0]]) for w in omega]
    entries = np.ravel([(2.0 * OSCILLATOR_DAMPING * w, 0.0) for w in omega])[:, None]
    held, driven = hold(block_diag(*blocks), entries, plant.control_interval)
    each = np.kron(np.eye(p + m), driven.T)
    n, shown = each.shape[1], len(shown_states(plant, modes)) + plant.disturbance_input.shape[1]
    parts = np.kron(np.eye(p + m), held).T, each[p:], each[:p], np.zeros((n, p)), np.zeros((n, shown))
    return Belief(*(np.ascontiguousarray(part, dtype=np.float32) for part in parts))


class Regression:
    """Sums over a batch from which the estimate is fitted: displacements and velocities of the slowest ``modes``, and the load."""

    def __init__(self, task: Task, modes: int) -> None:
        self._columns = shown_states(task.plant, modes)
        size = np.sqrt((typical_state(task)[self._columns] ** 2).mean())
        self._unit = np.concatenate([np.full(len(self._columns), size), load_unit(task.plant).astype(np.float64)])
        self._latest: list[Array] = []
        self._sums: list[Array] = []

    def add(self, oscillators: Array, state: Array, loads: Array) -> None:
        """One instant of N blades: (N, n) oscillators, (N, …) true states, (N, k) coming loads."""
        numbers, targets = oscillators.astype(np.float64), np.hstack([state[:, self._columns], loads]) / self._unit
        parts = [numbers.T @ numbers, numbers.T @ targets]
        self._latest = [old + new for old, new in zip(self._latest, parts, strict=True)] if self._latest else parts

    def fit(self) -> Array:
        """(n, f): from oscillators to the estimate, by what was added since the last fit and, fading, before."""
        scale = 1.0 / max(float(np.trace(self._latest[0])), 1e-30)
        latest = [scale * part for part in self._latest]
        self._sums = [new + MEMORY * old for new, old in zip(latest, self._sums, strict=True)] if self._sums else latest
        self._latest = []
        squares, products = self._sums
        ridge = np.diag(RIDGE * np.diag(squares) + 1e-12)
        return np.asarray(np.linalg.solve(squares + ridge, products), np.float32)

    def state_dict(self) -> dict[str, Any]:
        """Copies of the sums."""
        return {"latest": [part.copy() for part in self._latest], "sums": [part.copy() for part in self._sums]}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict``."""
        self._latest, self._sums = ([np.array(part) for part in state[name]] for name in ("latest", "sums"))
