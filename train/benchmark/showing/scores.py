"""Scores over whole splits, and what there is left to gain."""

from __future__ import annotations

from train.benchmark.score import SPLITS, Aggregate, aggregates, headrooms
from train.benchmark.showing.section import Entry, Section, cost, gap, words
from train.benchmark.table import BenchmarkTable
from train.shared.markdown import escaped

HEADROOM = (
    "What is left to gain: J / J₀ of the best controller of tiers 0 to 2, of any kind and on these very seeds, less that of "
    "clairvoyant, which is told each episode's truth; in pairs. Below zero it is ahead of clairvoyant."
)
SCORES = "Of every controller that was measured in all scenarios of a split that have a score."


def scores(table: BenchmarkTable) -> Section:
    """The score over each split, of everyone who has one."""
    found = aggregates(table)
    splits = {each.split: each for each in found}
    headings = ["controller", "tier", "kind"]
    for split, one in splits.items():
        headings += [f"{split}, {len(one.scenarios)} of {len(SPLITS[split])} scenarios", "less LQG's"]
    rows = []
    for name in dict.fromkeys(each.controller for each in found):
        own = {each.split: each for each in found if each.controller == name}
        one = next(iter(own.values()))
        rows.append([*words(name, one.tier, one.kind), *(entry for split in splits for entry in _entries(own.get(split)))])
    over = "\n".join(f"- {escaped(one.split)}: {_over(one)}." for one in splits.values())
    return Section("Score over scenarios", f"{SCORES}\n\n{over}", headings, rows, 3)


def _over(one: Aggregate) -> str:
    """Which scenarios a score is over."""
    return ", ".join(one.scenarios) + (f"; without a score: {', '.join(one.without)}" if one.without else "")


def _entries(one: Aggregate | None) -> list[Entry]:
    """Dashes for who was not measured in all scenarios."""
    return [cost(None), gap(None)] if one is None else [cost(one.score), gap(one.less_lqg)]


def headroom(table: BenchmarkTable) -> Section:
    """How far the best of those who are told less is from the clairvoyant law, scenario by scenario."""
    rows = []
    for each in headrooms(table):
        absolute = [cost(one.estimates["relative_cost"]) for one in (each.clairvoyant, each.best)]
        whose = words(each.scenario, each.best.controller, each.best.tier, each.best.kind)
        rows.append([*whose, *absolute, gap(each.cost), gap(each.score)])
    headings = ["scenario", "least J, tier 3 aside", "tier", "kind", "J / J₀ of clairvoyant", "J / J₀", "headroom", "as score"]
    return Section("Headroom", HEADROOM, headings, rows, 4)
