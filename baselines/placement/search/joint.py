"""Both sides' positions together: SQP from where one side after the other ends, and from the best of many random layouts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from baselines.placement.cost.joint_problem import JointProblem
from baselines.placement.cost.problem import PlacementProblem
from baselines.placement.search.placement import BATCH
from baselines.placement.search.search import place
from beamenv.blade.layouts import SIDES, Side
from beamenv.configuration import Count, Flag, Instance, Refused, checked
from beamenv.patches.group import Positions

Array = NDArray[np.float64]

CANDIDATES, STARTS = 240, 6


@dataclass(frozen=True, slots=True)
class JointPlacement:
    """Where the patches of both sides were put together."""

    actuators: Positions
    """m from the root to the root-side edges, ascending."""
    sensors: Positions
    cost: float
    """J: mean of ½xᵀx + uᵀRu in the long run under LQG."""
    in_turn: dict[Side, Positions]
    """m: the actuators placed by tr(P) and then the sensors by tr(S)."""
    in_turn_cost: float
    """J of that layout, under the same loads and noise."""

    @property
    def gain(self) -> float:
        """Share of the cost of one side after the other that is saved."""
        return 1.0 - self.cost / self.in_turn_cost


def place_jointly(
    problem: JointProblem,
    seed: int = 0,
    progress: Callable[[float, float], None] | None = None,
    leave_unreached: bool = False,
) -> JointPlacement:
    """Positions of both sides of least cost of the closed loop, never dearer than one side after the other; the same seed gives the
    same positions.

    Raises ``ValueError`` for what is no problem, and for modes that patches cannot reach as ``place`` does.
    """
    checked("problem", problem, Instance(JointProblem))
    seed = checked("seed", seed, Count(0, 2**63 - 1))
    if not (progress is None or callable(progress)):
        raise Refused("progress", progress, "None or a function of the share done and the least cost")
    leave_unreached = checked("leave_unreached", leave_unreached, Flag())
    begin = one_after_the_other(problem, seed, leave_unreached)
    best, least = begin, float(problem.cost(begin[None])[0])
    in_turn_cost = least
    starts = [begin, *_promising(problem, np.random.default_rng(seed))]
    for k, start in enumerate(starts):
        found = descended(problem, start)
        cost = float(problem.cost(found[None])[0])
        if cost < least:
            best, least = found, cost
        if progress is not None:
            progress((k + 1) / len(starts), least)
    placed = _by_side(problem, best)
    return JointPlacement(placed["actuators"], placed["sensors"], least, _by_side(problem, begin), in_turn_cost)


def one_after_the_other(problem: JointProblem, seed: int = 0, leave_unreached: bool = False) -> Array:
    """(a + s,), m: actuators by tr(P) beside equally spaced sensors, then sensors by tr(S), as ``optimal_layout`` has them."""
    above = place(problem.actuators, "multistart", seed, leave_unreached=leave_unreached)
    placed = problem.actuators.configuration(above.positions)
    below = place(PlacementProblem.of(placed, "sensors"), "multistart", seed, leave_unreached=leave_unreached)
    return np.array([*above.positions, *below.positions])


def descended(problem: JointProblem, start: Array) -> Array:
    """The feasible layout (a + s,) to which SciPy's SLSQP descends from one."""
    length, reference = problem.bounds[0].length, float(problem.cost(start[None])[0])

    def scaled(x: Array) -> tuple[float, Array]:
        cost, slopes = problem.cost_and_slopes(x * length)
        return cost / reference, slopes * (length / reference)

    apart = _apart(problem)
    limits = [(side.low / length, side.high / length) for side in problem.bounds for _ in range(side.count)]
    spacing = {"type": "ineq", "fun": lambda x: apart @ x - 1.0, "jac": lambda x: apart}
    result = minimize(
        scaled,
        start / length,
        jac=True,
        method="SLSQP",
        bounds=limits,
        constraints=[spacing] if len(apart) else [],
        options={"maxiter": 100, "ftol": 1e-10},
    )
    sides = np.split(result.x * length, [problem.bounds[0].count])
    repaired = [bounds.repaired(side) for bounds, side in zip(problem.bounds, sides, strict=True)]
    return np.array(np.round(np.concatenate(repaired), 12), dtype=np.float64)


def _apart(problem: JointProblem) -> Array:
    """Rows of distances between neighbours of each side."""
    counts, total = [each.count for each in problem.bounds], sum(each.count for each in problem.bounds)
    every = np.eye(total, k=1)[:-1] - np.eye(total)[:-1]
    return np.asarray(np.delete(every, counts[0] - 1, axis=0), dtype=np.float64)


def _promising(problem: JointProblem, generator: np.random.Generator) -> list[Array]:
    """The best of random layouts, cheapest first."""
    layouts = np.concatenate([side.random(generator, CANDIDATES) for side in problem.bounds], axis=1)
    costs = np.concatenate([problem.cost(layouts[k : k + BATCH]) for k in range(0, CANDIDATES, BATCH)])
    return [layouts[k] for k in np.argsort(costs, kind="stable")[:STARTS]]


def _by_side(problem: JointProblem, positions: Array) -> dict[Side, Positions]:
    above, below = np.split(positions, [problem.bounds[0].count])
    return dict(zip(SIDES, (tuple(above.tolist()), tuple(below.tolist())), strict=True))
