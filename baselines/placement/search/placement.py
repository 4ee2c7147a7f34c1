"""What a search for positions returns, and how it keeps count on the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from baselines.placement.cost.problem import PlacementProblem
from beamenv.blade.bounds import TOLERANCE

Array = NDArray[np.float64]

Progress = Callable[[float, float], None]
"""Called now and then with the share of the search that is done (0 … 1) and the least cost so far."""

BATCH = 60
"""Layouts evaluated together: their matrices still fit into the processor's cache."""


@dataclass(frozen=True, slots=True)
class Placement:
    """Where a search put the patches of one side."""

    side: str
    """actuators or sensors."""
    method: str
    seed: int
    positions: tuple[float, ...]
    """m from the root to the root-side edges, ascending."""
    cost: float
    """tr(P) in s of actuators, tr(S) in J of sensors."""
    start: tuple[float, ...]
    """m: the layout that the search was given to better, uniform unless said otherwise."""
    start_cost: float
    history: tuple[tuple[int, float], ...]
    """(layouts evaluated, least cost so far) after each iteration."""
    evaluations: int
    seconds: float

    @property
    def gain(self) -> float:
        """Share of the start's cost that is saved."""
        return 1.0 - self.cost / self.start_cost


@dataclass(slots=True, eq=False)
class Recorder:
    """A placement problem that remembers its best feasible layout and what it took, and reports progress."""

    problem: PlacementProblem
    progress: Progress | None = None
    positions: Array = field(default_factory=lambda: np.empty(0))
    cost: float = np.inf
    evaluations: int = 0
    history: list[tuple[int, float]] = field(default_factory=list)
    begun: float = 0.0
    """Share of the whole search that came before the present stage."""
    share: float = 1.0
    """Share of the present stage."""

    def costs(self, positions: Array) -> Array:
        """Costs (N,) of feasible layouts (N, count); infinite where the equation has no solution."""
        chunks = [self.problem.cost(positions[k : k + BATCH]) for k in range(0, len(positions), BATCH)]
        costs = np.concatenate(chunks)
        costs[~np.isfinite(costs)] = np.inf
        self.evaluations += len(positions)
        best = int(costs.argmin())
        if costs[best] < self.cost:
            self._keep(self.problem.bounds.repaired(positions[best]), float(costs[best]))
        return costs

    def cost_and_slopes(self, positions: Array) -> tuple[float, Array]:
        """Cost and its slopes (count,) of one layout, which is remembered if it is feasible."""
        cost, slopes = self.problem.cost_and_slopes(positions)
        self.evaluations += 1
        if cost < self.cost:
            feasible = self.problem.bounds.repaired(positions)
            if np.abs(feasible - positions).max() <= TOLERANCE:
                self._keep(feasible, cost)
        return cost, slopes

    def note(self, done: float) -> None:
        """Write down where the search stands, ``done`` (0 … 1) being the share of the present stage."""
        self.history.append((self.evaluations, self.cost))
        if self.progress is not None:
            self.progress(self.begun + self.share * min(done, 1.0), self.cost)

    def _keep(self, feasible: Array, cost: float) -> None:
        self.cost, self.positions = cost, np.round(feasible, 12)  # 1e-18 m is 0
