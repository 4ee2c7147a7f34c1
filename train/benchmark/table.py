"""The table: every controller in every scenario, its estimates made of the cells of its training runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Estimate
from baselines.evaluation.metrics import judged
from train.benchmark import statistics
from train.benchmark.cells import SERIES, Cell
from train.benchmark.failures import Failures, failures
from train.benchmark.listed import ListedController, place

Array = NDArray[np.float64]

UNSTABLE = 2.0
"""An episode counts as unstable if the blade fails in it or if J is more than so many times what it is without control: a
controller that feeds vibration may well take longer than an episode to break the blade."""

RIVAL = "lqg"

CLAIRVOYANT = "clairvoyant"
"""What scores relate to: it is told each episode's truth."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """One controller in one scenario."""

    scenario: str
    controller: str
    title: str
    kind: str
    tier: int
    """Of information, in ``beamenv.titles.TIERS``."""
    runs: int
    """Training runs that were measured; 1 for what does not learn."""
    seeds: int
    sentences: tuple[str, ...] = ()
    """What went wrong, once each."""
    everywhere: bool = True
    """Whether the same runs are put through every scenario; a specialist's are each scenario's own."""
    estimates: Mapping[str, Estimate] = field(default_factory=dict)
    """In SI units; empty where nothing could be measured."""
    cost: Array | None = None
    """(runs, N), J s; J₀ where a blade fails with and without control, infinite where it fails under the controller alone."""
    uncontrolled: Array | None = None
    """(N,), J s: J₀."""
    failures: Failures | None = None
    """How many blades fail without control, and are saved or lost; None where nothing was measured."""
    scored: Array | None = None
    """(1 + R,): the score and those of R resamples; None without."""

    @property
    def measured(self) -> bool:
        """Whether there is anything to compare."""
        return self.cost is not None

    @property
    def mean_cost(self) -> float:
        """J s, infinite where nothing was measured or the controller breaks a blade."""
        return float("inf") if self.cost is None else float(self.cost.mean())


@dataclass(frozen=True, slots=True, eq=False)
class BenchmarkTable:
    """Everything a benchmark has found out."""

    rows: tuple[Row, ...]
    """Scenario by scenario; within one by tier and kind, then as they are listed."""
    refused: Mapping[str, str]
    """Scenarios that could not be read, and why."""
    configuration: Mapping[str, Any]
    """How it was made, as JSON can hold it."""
    left_out: tuple[str, ...] = ()
    """In a sentence each, what cannot be had of a model of one's own."""

    @property
    def scenarios(self) -> tuple[str, ...]:
        """In order."""
        return tuple(dict.fromkeys(row.scenario for row in self.rows))

    @property
    def controllers(self) -> tuple[str, ...]:
        """By tier and kind."""
        places = {row.controller: place(row.tier, row.kind) for row in self.rows}
        return tuple(sorted(places, key=places.__getitem__))

    def within(self, scenario: str) -> tuple[Row, ...]:
        """The rows of a scenario."""
        return tuple(row for row in self.rows if row.scenario == scenario)

    def row(self, scenario: str, controller: str) -> Row | None:
        """One row, None if the controller has nothing to do there."""
        return next((row for row in self.within(scenario) if row.controller == controller), None)

    @property
    def sentences(self) -> dict[str, str]:
        """Everything that went wrong, by where it did."""
        rows = {f"{row.controller} in {row.scenario}": " ".join(row.sentences) for row in self.rows if row.sentences}
        return {**{f"scenario {name}": sentence for name, sentence in self.refused.items()}, **rows}


def tabulate(
    cells: Sequence[Cell], listed: Sequence[ListedController], refused: Mapping[str, str], configuration: Mapping[str, Any]
) -> BenchmarkTable:
    """The table of all cells."""
    rows = []
    for scenario in dict.fromkeys(cell.scenario for cell in cells):
        found = {each.name: [c for c in cells if (c.scenario, c.controller) == (scenario, each.name)] for each in listed}
        rivals, clairvoyant = costs(found.get(RIVAL, [])), costs(found.get(CLAIRVOYANT, []))
        rows += [row(found[each.name], each, rivals, clairvoyant) for each in listed if found[each.name]]
    return BenchmarkTable(tuple(rows), refused, configuration)


def costs(cells: Sequence[Cell]) -> Array | None:
    """(runs, N), J s, as they stand over J₀, of the cells that were measured; None if none were."""
    series = [_judged(cell) for cell in cells if cell.metrics is not None]
    return np.stack(series) if series else None


def _judged(cell: Cell) -> Array:
    assert cell.metrics is not None and cell.uncontrolled is not None and cell.fails is not None
    return judged(cell.metrics["cost"], cell.uncontrolled, cell.fails > 0.0)


def row(cells: Sequence[Cell], listed: ListedController, rival: Array | None, clairvoyant: Array | None) -> Row:
    """The training runs of one controller in one scenario taken together."""
    served = [cell for cell in cells if cell.metrics is not None]
    title = listed.title or (served or cells)[0].title or listed.name
    sentences = tuple(dict.fromkeys(cell.sentence for cell in cells if cell.sentence))
    if served and len(served) < len(cells):
        sentences = (f"{len(cells) - len(served)} of {len(cells)} runs could not be measured:", *sentences)
    scenario, everywhere = cells[0].scenario, bool(listed.everywhere)
    empty = Row(scenario, listed.name, title, listed.kind, listed.tier, 0, 0, sentences, everywhere)
    if not served:
        return empty
    series = {name: np.stack([cell.metrics[name] for cell in served if cell.metrics]) for name in SERIES}
    uncontrolled, fails = served[0].uncontrolled, served[0].fails
    assert uncontrolled is not None and fails is not None
    cost = np.stack([_judged(cell) for cell in served])
    found = estimates(series, cost, uncontrolled, rival)
    counted = failures(series["cost"], fails)
    measured = replace(empty, runs=len(served), seeds=len(uncontrolled), estimates=found, failures=counted)
    measured = replace(measured, cost=cost, uncontrolled=uncontrolled)
    scored = None if clairvoyant is None else statistics.scores(cost, clairvoyant, uncontrolled, "" if everywhere else scenario)
    if scored is None:
        return measured
    return replace(measured, estimates={"score": statistics.summary(scored), **found}, scored=scored)


def estimates(series: Mapping[str, Array], cost: Array, uncontrolled: Array, rival: Array | None) -> dict[str, Estimate]:
    """Every estimate from ``series`` and ``cost``, as it stands over J₀, (runs, N); those beside LQG only where it was measured."""
    found = {
        "relative_cost": statistics.relative_cost(cost, uncontrolled),
        "relative_cost_iqm": statistics.pooled_interquartile_mean(cost / uncontrolled),
        "unstable": statistics.mean((series["cost"] > UNSTABLE * uncontrolled).astype(float)),
    }
    if rival is not None:
        found["difference_to_lqg"] = statistics.difference(cost, rival, uncontrolled)
        found["improvement_on_lqg"] = statistics.mean(statistics.better(cost, rival[0]))
    return found | {name: statistics.mean(values) for name, values in series.items()}
