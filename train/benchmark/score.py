"""Scores of whole splits of scenarios, and how much there is left to gain in each scenario."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from baselines import Estimate
from beamenv.knowledge import TRUTH
from beamenv.scenarios.named import BENCHMARK, OPEN, UNSEEN
from beamenv.scenarios.scenario import SCENARIOS
from train.benchmark import statistics
from train.benchmark.table import CLAIRVOYANT, RIVAL, BenchmarkTable, Row

Array = NDArray[np.float64]

SPLITS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"single fault": tuple(name for name in BENCHMARK if name not in UNSEEN), "open": OPEN, "unseen": UNSEEN}
)
"""Scenarios by what they ask for; each is in one split."""

RULE = (
    "How much of what can be gained is gained: (J₀ − J) / (J₀ − J of clairvoyant), each a mean over seeds and runs. 0 is no "
    "control, 1 is clairvoyant, which is told each episode's truth; below 0 is worse than no control. The score of a split is "
    "the interquartile mean of those of its scenarios."
)
"""What a score is, for whoever shows one."""

DETAILS = (
    "Scores are not clipped. clairvoyant is a reference, no bound, for it estimates loads as others do: a score may be above 1. A "
    "scenario has no score where clairvoyant was not measured, which refuses plants that change within an episode, breaks a blade, "
    "or gains nothing in some resample; the split then stands on the others. Intervals draw training runs within each scenario "
    "(Agarwal et al., NeurIPS 2021), those of a generalist together, for they are the same in all scenarios; seeds are drawn "
    "together for all scenarios and controllers, so that differences are paired."
)
"""By which rules it is made."""


@dataclass(frozen=True, slots=True)
class Aggregate:
    """A controller's score over the scenarios of a split."""

    split: str
    controller: str
    tier: int
    kind: str
    score: Estimate
    less_lqg: Estimate | None
    """The score less LQG's, in pairs; None where LQG was not measured."""
    scenarios: tuple[str, ...]
    """Those it is over."""
    without: tuple[str, ...]
    """Those of the split in the table in which there is no score."""


@dataclass(frozen=True, slots=True)
class Headroom:
    """How far the best of those who are not told the truth is from who is, in one scenario. Negative where it is ahead."""

    scenario: str
    best: Row
    """The least mean J on these very seeds."""
    clairvoyant: Row
    cost: Estimate
    """Of J / J₀, in pairs."""
    score: Estimate | None
    """1 less its score."""


def split_of(table: BenchmarkTable, scenario: str) -> str:
    """The split of a scenario of the table; empty for one that only has the name of such."""
    told = table.configuration.get("scenarios", {}).get(scenario)
    itself = scenario in SCENARIOS and told in (None, SCENARIOS[scenario].to_dict())
    return next((split for split, names in SPLITS.items() if itself and scenario in names), "")


@lru_cache(maxsize=1)
def by_split(table: BenchmarkTable) -> dict[str, str]:
    """The splits of scenarios, in their order; "other" for those of none."""
    splits = {name: split_of(table, name) or "other" for name in table.scenarios}
    order = (*SPLITS, "other")
    return dict(sorted(splits.items(), key=lambda item: order.index(item[1])))


def aggregates(table: BenchmarkTable) -> list[Aggregate]:
    """Split by split, of every controller that was measured in all scenarios of the split that have a score: others have none.

    Who is at home in some scenarios only cannot be compared with who faces all.
    """
    found = []
    for split in SPLITS:
        names = [name for name in table.scenarios if split_of(table, name) == split]
        scored = {name: each for name in names if (each := _scored(table, name))}
        if scored:
            found += _aggregates(table, split, scored, tuple(name for name in names if name not in scored))
    return found


def _scored(table: BenchmarkTable, scenario: str) -> dict[str, Array]:
    """(1 + R,): the score and its resamples of each controller in a scenario; empty without."""
    return {row.controller: row.scored for row in table.within(scenario) if row.scored is not None}


def _aggregates(
    table: BenchmarkTable, split: str, scored: Mapping[str, Mapping[str, Array]], without: tuple[str, ...]
) -> list[Aggregate]:
    together = {
        name: statistics.over_scenarios([each[name] for each in scored.values()])
        for name in table.controllers
        if all(name in each for each in scored.values())
    }
    about = {row.controller: (row.tier, row.kind) for row in table.rows}
    return [
        Aggregate(
            split, name, *about[name], statistics.summary(found), _less_lqg(found, together.get(RIVAL)), tuple(scored), without
        )
        for name, found in together.items()
    ]


def _less_lqg(found: Array, rival: Array | None) -> Estimate | None:
    return None if rival is None else statistics.summary(statistics.less(found, rival))


def headrooms(table: BenchmarkTable) -> list[Headroom]:
    """Of every scenario in which the clairvoyant law was measured."""
    found = (headroom(table.within(name)) for name in table.scenarios)
    return [each for each in found if each is not None]


def headroom(rows: Sequence[Row]) -> Headroom | None:
    """Of one scenario's rows; None without the clairvoyant law or without any other."""
    clairvoyant = next((row for row in rows if row.controller == CLAIRVOYANT and row.measured), None)
    told_less = [row for row in rows if row.measured and row.tier < TRUTH]
    if clairvoyant is None or not told_less:
        return None
    best = min(told_less, key=lambda row: row.mean_cost)
    assert best.cost is not None and clairvoyant.cost is not None and best.uncontrolled is not None
    scored = best.estimates.get("score")
    left = None if scored is None else Estimate(1.0 - scored.value, 1.0 - scored.high, 1.0 - scored.low)
    return Headroom(best.scenario, best, clairvoyant, statistics.difference(best.cost, clairvoyant.cost, best.uncontrolled), left)
