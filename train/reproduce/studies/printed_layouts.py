"""The layouts that Tables 6.1 to 6.4 print, on our blades."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, Side, with_positions
from train.reproduce.studies.chapter6_columns import NUMBERS
from train.reproduce.studies.placement_study import problem_of
from train.reproduce.thesis import printed_table

Array = NDArray[np.float64]

UNPRINTED = "the thesis prints neither β, α and η of its weights, nor its noise, nor where its searches start"
"""Why what rests on more than the layouts cannot be evaluated."""


def printed_positions(side: Side, which: str, count: int, speed: float, method: str) -> Array:
    """Root-side edges (count,), m, by "ga" or "sqp": of Tables 6.1 and 6.2 ("four"), or 6.3 and 6.4 ("all"), SQP from GA."""
    rows = [row for row in printed_table(NUMBERS[side, which]) if float(row["speed"]) == speed]
    return np.array([float(row[f"{method}_position"]) for row in rows if int(row.get("count", count)) == count])


def cost_of(config: BladeConfig, side: Side, layout: Array, speed: float) -> float:
    """tr(P) or tr(S) of a layout on a blade, its patches moved apart where they overlap."""
    problem = problem_of(config, side, len(layout), speed)
    return float(problem.cost(np.atleast_2d(problem.bounds.repaired(layout)))[0])


def with_printed_optimum(blade: BladeConfig) -> BladeConfig:
    """The blade with the four actuators and four sensors of Tables 6.3 and 6.4 at its speed, moved apart where they overlap."""
    placed = blade
    for side in SIDES:
        layout = printed_positions(side, "all", 4, blade.speed, "sqp")
        apart = problem_of(blade, side, 4, blade.speed).bounds.repaired(layout)
        placed = with_positions(placed, {side: cast("tuple[float, ...]", tuple(np.ravel(apart).tolist()))})
    return replace(placed, sensor_full_scale=problem_of(blade, "actuators", 4, blade.speed).config.sensor_full_scale)
