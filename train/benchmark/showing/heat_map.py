"""Scenarios against controllers as a heat map."""

from __future__ import annotations

import numpy as np

from beamenv.knowledge import TRUTH
from train.benchmark.table import BenchmarkTable
from train.benchmark.targets import best
from train.figures.heat_map import HeatMap


def heat_map(table: BenchmarkTable) -> HeatMap:
    """All controllers but no control, which is 1 everywhere, tier by tier; the best of a scenario is not told the truth."""
    names = tuple(name for name in table.controllers if name != "none")
    tiers = {row.controller: f"tier {row.tier}" for row in table.rows}
    return HeatMap(
        table.scenarios,
        names,
        relative_cost=_estimates(table, names, "relative_cost"),
        failed=_estimates(table, names, "unstable"),
        kinds=tuple(tiers[name] for name in names),
        best=tuple(_best(table, scenario) for scenario in table.scenarios),
        lost=frozenset((row.scenario, row.controller) for row in table.rows if not row.measured),
    )


def _estimates(table: BenchmarkTable, names: tuple[str, ...], estimate: str) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """(S, C): NaN where a controller has nothing to do or could not be measured."""
    rows = [[table.row(scenario, name) for name in names] for scenario in table.scenarios]
    return np.array([[row.estimates[estimate].value if row and row.measured else np.nan for row in line] for line in rows])


def _best(table: BenchmarkTable, scenario: str) -> str:
    first = best(row for row in table.within(scenario) if row.tier < TRUTH)
    return first.controller if first else ""
