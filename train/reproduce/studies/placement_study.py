"""Chapter 6 of the thesis as numbers: Tables 6.1 to 6.4, what its conclusions (§6.6) are judged by, optimisers compared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from baselines.placement import Placement, PlacementProblem, place
from baselines.placement.cost.damping import design_poles
from baselines.placement.search.genetic import Genetic
from baselines.placement.search.placement import Recorder
from baselines.placement.search.sqp import SequentialQuadratic
from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, Side, with_positions

Array = NDArray[np.float64]

SPEEDS = (0.0, 200.0)
COUNTS = (1, 2, 3, 4)


@dataclass(frozen=True, slots=True)
class TableRow:
    """One number of patches at one speed, placed in three ways."""

    side: Side
    count: int
    speed: float
    """rad/s."""
    ga: Placement
    sqp: Placement
    """SQP alone, from equally spaced patches (the thesis does not say where its own started)."""
    both: Placement
    """GA, then SQP."""
    uniform_cost: float


@lru_cache(maxsize=64)
def problem_of(config: BladeConfig, side: Side, count: int, speed: float) -> PlacementProblem:
    """The placement problem of a table's row."""
    return PlacementProblem.of(replace(config, speed=speed), side, count)


def table_row(side: Side, count: int, speed: float, blade: BladeConfig, seed: int = 0) -> TableRow:
    """A row of Table 6.1 or 6.3 (actuators), 6.2 or 6.4 (sensors); 6.1 and 6.2 are those of four patches."""
    problem = problem_of(blade, side, count, speed)
    ga = place(problem, Genetic(), seed)
    sqp = place(problem, SequentialQuadratic(), seed)
    both = place(problem, SequentialQuadratic(), seed, start=ga.positions)
    return TableRow(side, count, speed, ga, sqp, both, sqp.start_cost)


def shift_with_speed(rows: Sequence[TableRow]) -> dict[int, tuple[float, float]]:
    """Mean root-side edge (m) of the placed patches at rest and at 200 rad/s, by their number."""
    means = {(row.count, row.speed): float(np.mean(row.both.positions)) for row in rows}
    return {count: (means[count, SPEEDS[0]], means[count, SPEEDS[1]]) for count in sorted({row.count for row in rows})}


def gathering_at_the_root(sensors: Sequence[TableRow], actuators: Sequence[TableRow]) -> list[tuple[int, float, float, float]]:
    """Of each number and speed: mean root-side edge (m) of the placed sensors, and of the placed actuators."""
    pairs = zip(sensors, actuators, strict=True)
    return [(s.count, s.speed, float(np.mean(s.both.positions)), float(np.mean(a.both.positions))) for s, a in pairs]


def together_against_alone(rows: Sequence[TableRow]) -> list[tuple[float, float]]:
    """What GA alone and SQP alone cost more than the two in turn, as shares: (GA, SQP) of each row."""
    return [(row.ga.cost / row.both.cost - 1.0, row.sqp.cost / row.both.cost - 1.0) for row in rows]


def descents(side: Side, count: int, speed: float, blade: BladeConfig, starts: int, seed: int = 0) -> Array:
    """(starts,): where SQP ends from random layouts."""
    problem = problem_of(blade, side, count, speed)
    layouts = problem.bounds.random(np.random.default_rng(seed), starts)
    return np.array([place(problem, SequentialQuadratic(), start=layout).cost for layout in layouts])


def starts_that_fail(found: Array, known: float, tolerance: float = 1e-4) -> float:
    """Share of ``descents`` that end dearer than the best, found by them or ``known``, by more than ``tolerance``."""
    return float(np.mean(found > min(float(found.min()), known) * (1.0 + tolerance)))


def convergence(blade: BladeConfig, population: int, generations: int = 50, seed: int = 0) -> Array:
    """Figure 6.4: least tr(P) (generations,) of four actuators at 200 rad/s after each generation of a population."""
    recorder = Recorder(PlacementProblem.of(blade, "actuators"))
    genetic = Genetic(population=population, generations=generations)
    genetic.run(recorder, recorder.problem.bounds.uniform(), np.random.default_rng(seed))
    return np.array([cost for _, cost in recorder.history])


@dataclass(frozen=True, slots=True, eq=False)
class Layouts:
    """A blade with equally spaced patches, and with both sides placed: actuators first, then the sensors."""

    initial: BladeConfig
    optimal: BladeConfig
    """With the data acquisition of the initial one."""
    actuators: PlacementProblem
    sensors: PlacementProblem


def initial_and_optimal(blade: BladeConfig, row: TableRow, seed: int = 0) -> Layouts:
    """The blades that Figures 6.5 (untwisted), 6.6 (pretwisted) and 6.7 compare, with the actuators of a ``table_row`` of it."""
    actuators = PlacementProblem.of(blade, "actuators")
    placed = with_positions(blade, {"actuators": row.both.positions})
    sensors = PlacementProblem.of(placed, "sensors")
    optimal = replace(
        sensors.configuration(place(sensors, "ga+sqp", seed).positions), sensor_full_scale=actuators.config.sensor_full_scale
    )
    return Layouts(replace(blade, sensor_full_scale=actuators.config.sensor_full_scale), optimal, actuators, sensors)


def poles(layouts: Layouts) -> dict[tuple[Side, str], NDArray[np.complex128]]:
    """Figure 6.7: regulator's ("actuators") and filter's ("sensors") poles (2r,), rad/s, "initial" and "optimal"."""
    found = {}
    for side, problem in zip(SIDES, (layouts.actuators, layouts.sensors), strict=True):
        placed = getattr(layouts.optimal.patches, side)
        found[side, "initial"] = design_poles(problem, problem.bounds.uniform())
        found[side, "optimal"] = design_poles(problem, placed)
    return found


def depth(shown: NDArray[np.complex128]) -> tuple[float, float]:
    """How deep poles lie in the left half plane, rad/s: the slowest one's −Re, and the mean −Re."""
    return float(-shown.real.max()), float(-shown.real.mean())


def variants(blade: BladeConfig, count: int = 2) -> dict[str, tuple[BladeConfig, int]]:
    """The untwisted blade at 200 rad/s with some patches to be placed, and one thing after another changed (§6.6)."""
    return {
        "as it is": (blade, count),
        "at rest": (replace(blade, speed=0.0), count),
        "pretwist 30°": (replace(blade, beam=replace(blade.beam, pretwist_deg=30.0)), count),
        "presetting 30°": (replace(blade, beam=replace(blade.beam, presetting_deg=30.0)), count),
        "one more": (blade, count + 1),
    }


def placed(side: Side, count: int, blade: BladeConfig, seed: int = 0) -> Placement:
    """By SQP from many starts."""
    return place(problem_of(blade, side, count, blade.speed), "multistart", seed)
