"""Who leads in each tier, and agents against classical controllers."""

from __future__ import annotations

from beamenv.titles import TIERS
from train.benchmark.contests import Contest, contests, corrected, rule
from train.benchmark.showing.section import Entry, Section, gap, in_words, words
from train.benchmark.table import BenchmarkTable, Row
from train.benchmark.targets import leaders_of
from train.shared.columns import number, share

LEADERS = (
    "The controller with the least mean J of each tier, of any kind and on these very seeds, with its J / J₀. By the paired "
    "intervals it is below every other of its tier, unless the cell says “not clearly”, or “the only one” of its tier."
)


def leaders(table: BenchmarkTable) -> Section:
    """The least J of each tier in each scenario."""
    tiers = [tier for tier in TIERS if any(row.measured and row.tier == tier for row in table.rows)]
    rows = [words(name, *(_leader(table, name, tier) for tier in tiers)) for name in table.scenarios] if tiers else []
    headings = ["scenario", *(f"tier {tier}, {TIERS[tier]}" for tier in tiers)]
    return Section("Least J by tier", LEADERS, headings, rows, len(headings))


def _leader(table: BenchmarkTable, scenario: str, tier: int) -> str:
    first = leaders_of(table).get((scenario, tier))
    if first is None:
        return "–"
    how = ", the only one" if not first.rivals else "" if first.clear else ", not clearly"
    cost = number(first.row.estimates["relative_cost"].value, "{:.3f}")
    return f"{in_words(first.row.controller)} {cost}{_unstable(first.row)}{how}"


def _unstable(row: Row) -> str:
    part = row.estimates["unstable"].value
    return f" ({share(part)} unstable)" if part else ""


def agents_and_laws(table: BenchmarkTable) -> Section:
    """One of each against the other in each scenario."""
    found = contests(table)
    headings = ["scenario", "agent", "classical", "verdict", "all judged together", "hardest"]
    headings += ["J / J₀, agent less classical", "agent less the hardest"]
    rows = [_contest(each, left) for each, left in zip(found, corrected(found), strict=True)]
    return Section("Agents against classical controllers", rule(), headings, rows, 6)


def _contest(one: Contest, left: str) -> list[Entry]:
    names = _name(one.agent, one.agent_chosen), _name(one.law, one.law_chosen)
    return [*words(one.scenario, *names, one.verdict, left, one.hardest.controller), gap(one.gap), gap(one.least_clear)]


def _name(row: Row, chosen: bool) -> str:
    """In brackets where nobody was chosen."""
    return (row.controller if chosen else f"({row.controller})") + _unstable(row)
