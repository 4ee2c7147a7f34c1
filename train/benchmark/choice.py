"""Who stands for the agents and who for the laws: chosen on validation seeds, before those that all are judged on are looked at."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.configuration import Count, Text, checked, checked_table
from beamenv.configuration.files import of_file
from beamenv.scenarios.named import BENCHMARK, OPEN, UNSEEN
from train.benchmark import statistics
from train.benchmark.cells import sources_digest
from train.benchmark.listed import LEARNT
from train.benchmark.table import BenchmarkTable, Row
from train.shared.files import read_json, write_json

FILE = Path(__file__).with_name("chosen.json")
"""The choice that ships; ``python -m train.benchmark.choose`` makes it anew."""

SCENARIOS = tuple(name for name in (*BENCHMARK, *OPEN) if name not in UNSEEN)
"""Those that are chosen on."""

KINDS = ("agents", "laws")

SAME_EVERYWHERE = ("multiple-model-general",)
"""Laws of tier 1 that take nothing of the scenario. What the others are told makes them what they are: where a scenario is kept for
judging they are told of none, and are other laws than those that were measured."""


@dataclass(frozen=True, slots=True)
class Choice:
    """Names of controllers, by scenario; of laws those that are told no more than agents."""

    first: int
    """Of the seeds chosen on."""
    seeds: int
    """How many."""
    digest: str
    """Of the code that measured them."""
    agents: Mapping[str, str] = field(default_factory=dict)
    laws: Mapping[str, str] = field(default_factory=dict)
    everywhere: Mapping[str, str] = field(default_factory=dict)
    """Of "agents" and of "laws": who stands for them in scenarios that are not chosen on."""

    def name(self, kind: str, scenario: str) -> str:
        """Who stands for "agents" or "laws" in a scenario; empty if nobody was chosen."""
        chosen: Mapping[str, str] = getattr(self, kind)
        return chosen.get(scenario, self.everywhere.get(kind, "") if scenario not in SCENARIOS else "")


def agents(rows: Iterable[Row]) -> list[Row]:
    """Those that have learned and are told the scenario's distribution and the readings at most, as measured."""
    return [row for row in rows if row.measured and row.kind == "learned" and row.tier <= LEARNT]


def laws(rows: Iterable[Row]) -> list[Row]:
    """Those of every other kind that are told no more than agents; what a caller brings along is neither."""
    return [row for row in rows if row.measured and row.kind not in ("learned", "own") and row.tier <= LEARNT]


def is_same_everywhere(row: Row) -> bool:
    """Whether a controller is no other where it is told nothing of the scenario."""
    return row.tier == 0 or (row.everywhere if row.kind == "learned" else row.controller in SAME_EVERYWHERE)


GROUPS = {"agents": agents, "laws": laws}


def choose(table: BenchmarkTable) -> Choice:
    """Of a table on validation seeds: in each scenario the least mean J.

    Elsewhere the least interquartile mean over these of J / J₀, of who was measured in all of them and is the same in all of them:
    agents, laws of tier 0, and ``SAME_EVERYWHERE``.
    """
    found: dict[str, dict[str, str]] = {kind: {} for kind in GROUPS}
    everywhere = {}
    for kind, group in GROUPS.items():
        rows = {name: group(table.within(name)) for name in table.scenarios}
        found[kind] = {name: min(each, key=lambda row: row.mean_cost).controller for name, each in rows.items() if each}
        ratios: dict[str, list[float]] = {}
        for row in (row for each in rows.values() for row in each if is_same_everywhere(row)):
            ratios.setdefault(row.controller, []).append(row.estimates["relative_cost"].value)
        means = {name: statistics.interquartile_mean(np.array(each)) for name, each in ratios.items() if len(each) == len(rows)}
        if means:
            everywhere[kind] = min(means, key=lambda name: float(means[name]))
    first, last = table.configuration["seeds"]
    return Choice(first, last - first + 1, sources_digest(), found["agents"], found["laws"], everywhere)


def write_choice(path: Path, choice: Choice) -> None:
    """As JSON."""
    write_json(path, asdict(choice))


def read_choice(path: Path = FILE) -> Choice | None:
    """None where there is none; ``ValueError`` names a file that is not one."""
    if not path.exists():
        return None
    content: Any = read_json(path)
    with of_file(path):
        told = checked_table("choice", content, ("first", "seeds", "digest", *KINDS, "everywhere"))
        first, seeds = checked("choice.first", told.get("first"), Count(0)), checked("choice.seeds", told.get("seeds"), Count())
        places = {**dict.fromkeys(KINDS, SCENARIOS), "everywhere": KINDS}
        names = {kind: _names(f"choice.{kind}", told.get(kind, {}), known) for kind, known in places.items()}
        return Choice(first, seeds, checked("choice.digest", told.get("digest"), Text()), **names)


def _names(name: str, value: Any, known: Sequence[str]) -> dict[str, str]:
    return {key: checked(f"{name}.{key}", each, Text()) for key, each in checked_table(name, value, known).items()}
