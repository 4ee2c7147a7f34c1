"""Scores over whole splits, and what there is left to gain, as Markdown."""

from __future__ import annotations

from train.benchmark.score import SPLITS, Aggregate, aggregates, headrooms
from train.benchmark.table import BenchmarkTable
from train.shared.columns import Column
from train.shared.markdown import escaped
from train.shared.markdown import table as markdown_table

COST, GAP = (Column("", "", 1.0, form, interval=True) for form in ("{:.3f}", "{:+.3f}"))
"""How costs and scores are written, and how differences of such."""

HEADROOM = (
    "How far the least J of tiers 0 to 2, of all kinds and the least on these very seeds, is from that of clairvoyant, in pairs. "
    "Below zero it is ahead of it."
)


def scores(table: BenchmarkTable) -> str:
    """The score over each split, of everyone who has one; empty without any."""
    found = aggregates(table)
    splits = {each.split: each for each in found}
    if not splits:
        return ""
    headings = ["controller", "tier", "kind"]
    for split, one in splits.items():
        headings += [f"{split}, {len(one.scenarios)} of {len(SPLITS[split])} scenarios", "less LQG's"]
    rows = []
    for name in dict.fromkeys(each.controller for each in found):
        own = {each.split: each for each in found if each.controller == name}
        one = next(iter(own.values()))
        rows.append([name, str(one.tier), one.kind, *(text for split in splits for text in _score_cells(own.get(split)))])
    lines = [f"- {escaped(one.split)}: {_over(one)}." for one in splits.values()]
    return "\n\n".join(["### Score over scenarios", "\n".join(lines), markdown_table(headings, rows, words=3)])


def _over(one: Aggregate) -> str:
    """Which scenarios a score is over."""
    return ", ".join(one.scenarios) + (f"; without a score: {', '.join(one.without)}" if one.without else "")


def _score_cells(one: Aggregate | None) -> list[str]:
    """Dashes for who was not measured in all scenarios."""
    return ["–", "–"] if one is None else [COST.text(one.score), GAP.text(one.less_lqg)]


def headroom(table: BenchmarkTable) -> str:
    """How far the best of those who are told less is from the clairvoyant law, scenario by scenario; empty without it."""
    rows = []
    for each in headrooms(table):
        without = [COST.text(one.estimates["relative_cost"]) for one in (each.bound, each.best)]
        about = [each.scenario, each.best.controller, str(each.best.tier), each.best.kind]
        rows.append([*about, *without, GAP.text(each.cost), GAP.text(each.score)])
    if not rows:
        return ""
    headings = ["scenario", "least J, tier 3 aside", "tier", "kind", "J / J₀ of clairvoyant", "J / J₀", "headroom", "as score"]
    return f"### Headroom\n\n{HEADROOM}\n\n{markdown_table(headings, rows, words=4)}"
