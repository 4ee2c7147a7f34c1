"""SQP with exact slopes on everything at once, at no more mass and power than a design has or the budget allows."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from baselines.placement.sizing.designs import Designs, repaired, shortened
from baselines.placement.sizing.problem import SizingProblem

Array = NDArray[np.float64]


def polished(problem: SizingProblem, design: Designs, mass: float, iterations: int) -> tuple[Designs, Array]:
    """The design to which SLSQP descends from one (N = 1), of no more than ``mass`` (kg), and its cost (1,)."""
    limits, start = problem.limits, float(problem.cost(design)[0])
    there = design.lengths[0] > 0.0
    low, high = bounds_of(problem, there)
    free = np.flatnonzero(high > low)
    room = (high - low)[free]
    fixed = design.rows[0].copy()
    fixed[high == low] = low[high == low]

    def rows(genes: Array) -> Array:
        whole = fixed.copy()
        whole[free] = low[free] + genes * room
        return whole

    def scaled(genes: Array) -> tuple[float, Array]:
        cost, slopes = problem.cost_and_slopes(Designs.of_rows(rows(genes)[None]))
        return cost / start, slopes[free] * room / start

    rules = [gaps(problem, there), spending(problem, mass)]
    constraints: list[dict[str, Any]] = [
        {"type": "ineq", "fun": lambda x, r=rule: r[0](rows(x)), "jac": lambda x, r=rule: r[1](rows(x))[:, free] * room}
        for rule in rules
    ]
    result = minimize(
        scaled,
        (fixed[free] - low[free]) / room,
        jac=True,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * len(free),
        constraints=constraints,
        options={"maxiter": iterations, "ftol": 1e-7},
    )
    found = paid(problem, repaired(Designs.of_rows(rows(np.clip(result.x, 0.0, 1.0))[None]), limits))
    return found, problem.cost(found)


def bounds_of(problem: SizingProblem, there: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Least and largest rows (2 E + 4,): patches that are not there stay so."""
    limits, patches = problem.limits, len(there)
    starts = np.zeros(patches), np.where(there, limits.end - limits.length[0], 0.0)
    lengths = [np.where(there, bound, 0.0) for bound in limits.length]
    low, high = (np.concatenate([starts[k], lengths[k], (limits.least_sizes, limits.largest_sizes)[k]]) for k in range(2))
    return low, high


def gaps(problem: SizingProblem, there: NDArray[np.bool_]) -> tuple[Any, Any]:
    """What is left between neighbours and beyond the last patch, over the span, and its slopes by rows."""
    limits, patches = problem.limits, len(there)
    lines = []
    for side in (0, 1):
        own = np.flatnonzero((limits.side_of == side) & there)
        for here, beyond in zip(own, [*own[1:], None], strict=True):
            line = np.zeros(2 * patches + 4)
            line[[here, patches + here]] = -1.0
            if beyond is not None:
                line[beyond] = 1.0
            lines.append((line, 0.0 if beyond is not None else limits.end))
    matrix, constant = np.array([line for line, _ in lines]) / limits.end, np.array([each for _, each in lines]) / limits.end
    return (lambda rows: matrix @ rows + constant), (lambda rows: matrix)


def spending(problem: SizingProblem, mass: float) -> tuple[Any, Any]:
    """Shares of a mass (kg) and of the budget's power that are left, and their slopes by rows."""
    limits, power, per_volume = problem.limits, problem.budget.power, problem.power_per_volume
    per = [problem.densities / mass]
    if power is not None and per_volume is not None:
        per.append(np.array([per_volume / power, 0.0]))
    shares = np.array(per)

    def left(rows: Array) -> Array:
        return np.asarray(1.0 - shares @ Designs.of_rows(rows[None]).volumes(limits)[0])

    def slopes(rows: Array) -> Array:
        design = Designs.of_rows(rows[None])
        volumes, sizes = design.volumes(limits)[0], design.sizes[0]
        by_rows = np.zeros((2, len(rows)))
        for side in (0, 1):
            own = np.flatnonzero(limits.side_of == side)
            by_rows[side, len(limits.side_of) + own] = sizes[2 * side] * sizes[2 * side + 1]
            by_rows[side, [2 * side - 4, 2 * side - 3]] = volumes[side] / sizes[2 * side : 2 * side + 2]
        return np.asarray(-shares @ by_rows)

    return left, slopes


def paid(problem: SizingProblem, design: Designs) -> Designs:
    """The design with patches as much shorter as keeps it within the budget, of which rounding may have gone beyond."""
    if problem.within(design).all():
        return design
    mass, power = problem.mass(design)[0], problem.power(design)
    shares = [1.0]
    shares += [] if problem.budget.mass is None else [problem.budget.mass / mass]
    shares += [] if problem.budget.power is None or power is None else [problem.budget.power / power[0]]
    return repaired(shortened(design, float(min(shares))), problem.limits)


def leaner(problem: SizingProblem, design: Designs, mass: float) -> Designs:
    """A design like one (N = 1), of no more than ``mass`` (kg): shorter patches, and fewer where they are short already."""
    for _ in range(design.starts.shape[1]):
        share = min(mass / float(problem.mass(design)[0]), 1.0)
        shorter = repaired(shortened(design, share), problem.limits)
        if problem.mass(shorter)[0] <= mass:
            return shorter
        design = without_shortest(problem, shorter)
    return problem.least()


def without_shortest(problem: SizingProblem, design: Designs) -> Designs:
    """The design less its shortest patch, of a side that has another, and with sheets of the least size where none has."""
    lengths = design.lengths[0].copy()
    there = lengths > 0.0
    alone = np.array([np.count_nonzero(there[problem.limits.side_of == side]) == 1 for side in problem.limits.side_of])
    spare = np.flatnonzero(there & ~alone)
    if not len(spare):
        return replace(design, sizes=problem.limits.least_sizes[None])
    lengths[spare[lengths[spare].argmin()]] = 0.0
    return replace(design, lengths=lengths[None])
