"""Scenarios against the controllers that matter as a heat map."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from beamenv.knowledge import TRUTH
from train.benchmark.listed import GENERALIST
from train.benchmark.score import by_split
from train.benchmark.statistics import interquartile_mean
from train.benchmark.table import CLAIRVOYANT, RIVAL, BenchmarkTable
from train.benchmark.targets import best
from train.figures.heat_map import HeatMap

MOST = 13
"""Controllers that a page's width holds."""

REFERENCE = "truth"
"""The group of those that are told the truth."""

RULE = (
    f"The picture has all controllers where there are {MOST} at most, and else LQG, of each kind in tiers 0 to 2 and of the "
    "specialists who was measured in most scenarios and has the least interquartile mean of J / J₀ over them, the clairvoyant law, "
    "and the best generalists and the caller's own as far as there is room. The tables have all."
)
"""Who is shown, for whoever shows it."""


def heat_map(table: BenchmarkTable) -> HeatMap:
    """Scenarios split by split, controllers tier by tier but for no control, which is 1 everywhere.

    The best of a scenario is not told the truth, and need not be among those shown.
    """
    names, scenarios = shown(table), by_split(table)
    tiers = {row.controller: f"tier {row.tier}" for row in table.rows}
    return HeatMap(
        tuple(scenarios),
        names,
        relative_cost=_estimates(table, scenarios, names, "relative_cost"),
        failed=_estimates(table, scenarios, names, "unstable"),
        kinds=tuple(tiers[name] for name in names),
        best=tuple(_best(table, scenario) for scenario in scenarios),
        lost=frozenset((row.scenario, row.controller) for row in table.rows if not row.measured),
        groups=tuple(scenarios.values()),
    )


def shown(table: BenchmarkTable) -> tuple[str, ...]:
    """Who is in the picture, by ``RULE``."""
    names = [name for name in table.controllers if name != "none"]
    if len(names) <= MOST:
        return tuple(names)
    ranked = sorted(names, key=lambda name: _rank(table, name))
    groups = {name: _group(table, name) for name in ranked}
    firsts = {group: next(name for name in ranked if groups[name] == group) for group in groups.values() if group}
    if CLAIRVOYANT in names:
        firsts[REFERENCE] = CLAIRVOYANT
    chosen = dict.fromkeys([RIVAL, *firsts.values(), *(name for name in ranked if not groups[name])])
    kept = list(chosen)[:MOST]
    return tuple(name for name in names if name in kept)


def _group(table: BenchmarkTable, name: str) -> str:
    """Of which one is shown; empty for those that are all shown as far as there is room."""
    row = next(row for row in table.rows if row.controller == name)
    if row.kind == "own" or name.endswith(GENERALIST):
        return ""
    return REFERENCE if row.tier == TRUTH else f"{row.tier} {row.kind}"


def _rank(table: BenchmarkTable, name: str) -> tuple[int, float]:
    """Less is better: measured in more scenarios, then the interquartile mean of J / J₀ over them."""
    found = [row.estimates["relative_cost"].value for row in table.rows if row.controller == name and row.measured]
    return -len(found), float(interquartile_mean(np.array(found))) if found else np.inf


def _estimates(
    table: BenchmarkTable, scenarios: Iterable[str], names: tuple[str, ...], estimate: str
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """(S, C): NaN where a controller has nothing to do or could not be measured."""
    rows = [[table.row(scenario, name) for name in names] for scenario in scenarios]
    return np.array([[row.estimates[estimate].value if row and row.measured else np.nan for row in line] for line in rows])


def _best(table: BenchmarkTable, scenario: str) -> str:
    first = best(row for row in table.within(scenario) if row.tier < TRUTH)
    return first.controller if first else ""
