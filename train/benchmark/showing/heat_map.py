"""Scenarios against the controllers that matter, as a heat map."""

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

MOST = 9
"""Controllers that a page's width holds in letters that are easy to read."""

RULE = (
    f"The picture has all controllers where there are {MOST} at most, and else lqg, clairvoyant, the caller's own and, of tiers 0 "
    "to 2, the best classical controller and the best agent; then the best of the other generalists and classical controllers as "
    "far as there is room. The better was measured in more scenarios or has the lower interquartile mean of J / J₀ over as many. "
    "The tables have all."
)
"""Who is shown, for whoever shows it."""


def heat_map(table: BenchmarkTable) -> HeatMap:
    """Scenarios split by split, controllers tier by tier but for no control, which is 1 everywhere.

    The best of a scenario is the best of those shown who are not told the truth.
    """
    names, scenarios = shown(table), by_split(table)
    tiers = {row.controller: f"tier {row.tier}" for row in table.rows}
    return HeatMap(
        tuple(scenarios),
        names,
        relative_cost=_estimates(table, scenarios, names, "relative_cost"),
        failed=_estimates(table, scenarios, names, "unstable"),
        kinds=tuple(tiers[name] for name in names),
        best=tuple(_best(table, scenario, names) for scenario in scenarios),
        lost=frozenset((row.scenario, row.controller) for row in table.rows if not row.measured),
        groups=tuple(scenarios.values()),
    )


def shown(table: BenchmarkTable) -> tuple[str, ...]:
    """Who is in the picture, by ``RULE``."""
    names = [name for name in table.controllers if name != "none"]
    if len(names) <= MOST:
        return tuple(names)
    ranked = sorted(names, key=lambda name: _rank(table, name))
    rows = {row.controller: row for row in table.rows}
    told_less = [name for name in ranked if rows[name].tier < TRUTH]
    own = [name for name in ranked if rows[name].kind == "own"]
    firsts = {(rows[name].tier, rows[name].kind == "learned"): name for name in reversed(told_less)}
    generalists = [name for name in told_less if name.endswith(GENERALIST)]
    laws = [name for name in told_less if rows[name].kind != "learned"]
    wanted = dict.fromkeys(name for name in [RIVAL, CLAIRVOYANT, *own, *firsts.values(), *generalists, *laws] if name in names)
    kept = list(wanted)[:MOST]
    return tuple(name for name in names if name in kept)


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


def _best(table: BenchmarkTable, scenario: str, names: tuple[str, ...]) -> str:
    first = best(row for row in table.within(scenario) if row.tier < TRUTH and row.controller in names)
    return first.controller if first else ""
