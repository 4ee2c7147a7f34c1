"""The trade-off between what a closed loop costs and what its patches weigh: designs that none other betters in both."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from baselines.placement.search.placement import BATCH
from baselines.placement.sizing.designs import Designs, without_overlap
from baselines.placement.sizing.problem import SizingProblem

Array = NDArray[np.float64]

APART = 0.01
"""Shares of mass and of cost by which points of a front differ."""

Progress = Callable[[float, float], None]
"""Called now and then with the share of the search that is done (0 … 1) and the least cost so far, J."""


@dataclass(frozen=True, slots=True)
class Patch:
    """One patch."""

    start: float
    """m from the root."""
    length: float
    """m."""


@dataclass(frozen=True, slots=True)
class SizedPatches:
    """The patches of one side, of one sheet."""

    width: float
    """m."""
    thickness: float
    """m."""
    patches: tuple[Patch, ...]


@dataclass(frozen=True, slots=True)
class FrontPoint:
    """A design, what it costs and what it takes."""

    cost: float
    """J: mean of ½xᵀx + r uᵀu in the long run under LQG."""
    mass: float
    """kg of piezo sheet."""
    power: float | None
    """W: Σ ½CV²f at the voltage limit; None where the permittivity is unknown."""
    channels: int
    """Actuators, each with a voltage."""
    actuators: SizedPatches
    sensors: SizedPatches


@dataclass(frozen=True, slots=True)
class Front:
    """The trade-off of one blade."""

    points: tuple[FrontPoint, ...]
    """From the lightest to the heaviest, and so from the dearest to the cheapest."""
    seed: int
    evaluations: int
    complete: bool
    """Whether the search came to its end."""


@dataclass(slots=True, eq=False)
class Archive:
    """The best designs that a search has come upon, so far."""

    problem: SizingProblem
    progress: Progress | None = None
    designs: Designs | None = None
    cost: Array = field(default_factory=lambda: np.empty(0))
    evaluations: int = 0

    def costs(self, designs: Designs) -> Array:
        """J (N,) of feasible designs, of which those within the budget that none betters are kept."""
        chunks = [self.problem.cost(designs[slice(k, k + BATCH)]) for k in range(0, len(designs), BATCH)]
        cost = np.concatenate(chunks)
        cost[~np.isfinite(cost)] = np.inf
        self.evaluations += len(designs)
        self.keep(designs, cost)
        return cost

    def keep(self, designs: Designs, cost: Array) -> None:
        """Take those into account."""
        fine = np.flatnonzero(self.problem.within(designs) & np.isfinite(cost))
        parts = [designs[fine]] if self.designs is None else [self.designs, designs[fine]]
        joined, costs = Designs.joined(parts), np.concatenate([self.cost, cost[fine]])
        best = unbeaten(self.problem.mass(joined), costs)
        self.designs, self.cost = joined[best], costs[best]

    def note(self, done: float) -> None:
        """Report."""
        if self.progress is not None:
            self.progress(min(done, 1.0), float(self.cost.min(initial=np.inf)))

    def front(self, seed: int, complete: bool) -> Front:
        """What has been found, told apart by a per cent."""
        if self.designs is None:
            return Front((), seed, self.evaluations, complete)
        kept = told_apart(self.problem.mass(self.designs), self.cost)
        points = tuple(point(self.problem, self.designs[[k]], float(self.cost[k])) for k in kept)
        return Front(points, seed, self.evaluations, complete)


def unbeaten(mass: Array, cost: Array) -> NDArray[np.intp]:
    """Which of N designs no lighter one matches in cost, by mass; of equals the first."""
    order = np.lexsort((cost, mass))
    least = np.minimum.accumulate(cost[order])
    better = np.ones(len(order), dtype=bool)
    better[1:] = cost[order][1:] < least[:-1]
    return np.asarray(order[better])


def told_apart(mass: Array, cost: Array) -> list[int]:
    """Which designs of a front (N,), by mass, are a hundredth cheaper than the one before; of about one mass the cheapest."""
    kept: list[int] = []
    for k in range(len(mass)):
        if kept and cost[k] > (1.0 - APART) * cost[kept[-1]]:
            continue
        if kept and mass[k] < (1.0 + APART) * mass[kept[-1]]:
            kept.pop()
        kept.append(k)
    return kept


def point(problem: SizingProblem, design: Designs, cost: float) -> FrontPoint:
    """One design, told."""
    power = problem.power(design)
    sides = []
    for side in (0, 1):
        there = np.flatnonzero((problem.limits.side_of == side) & (design.lengths[0] > 0.0))
        starts, lengths = (np.round(each[0], 12) for each in (design.starts, design.lengths))  # 1e-18 m is 0
        patches = [Patch(float(starts[k]), float(lengths[k])) for k in there]
        width, thickness = design.sizes[0, 2 * side : 2 * side + 2].tolist()
        sides.append(SizedPatches(width, thickness, tuple(sorted(patches, key=lambda patch: patch.start))))
    mass, drawn = float(problem.mass(design)[0]), None if power is None else float(power[0])
    return FrontPoint(cost, mass, drawn, int(design.channels(problem.limits)[0]), *sides)


def feasible(problem: SizingProblem, designs: Designs) -> bool:
    """Whether every design can be made and paid for."""
    limits = problem.limits
    shortest, longest = limits.length
    there = designs.lengths[designs.lengths > 0.0]
    cut = np.all((there >= shortest * (1.0 - 1e-9)) & (there <= longest * (1.0 + 1e-9)))
    sheets = np.all((designs.sizes >= limits.least_sizes * (1 - 1e-9)) & (designs.sizes <= limits.largest_sizes * (1 + 1e-9)))
    return bool(cut and sheets and problem.within(designs).all() and without_overlap(designs, limits))
