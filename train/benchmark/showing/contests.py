"""Who leads in each tier, and agents against laws, as Markdown."""

from __future__ import annotations

from beamenv.knowledge import TIERS
from train.benchmark.contests import RULE, Contest, contests
from train.benchmark.showing.scores import COST, GAP
from train.benchmark.table import BenchmarkTable, Row
from train.benchmark.targets import leader
from train.shared.columns import share
from train.shared.markdown import table as markdown_table

LEADERS = (
    'The least mean J of each tier, of all kinds and on these very seeds. "clearly": below every other of its tier, each by the '
    "paired interval."
)


def leaders(table: BenchmarkTable) -> str:
    """The least J of each tier in each scenario; empty where nothing was measured."""
    tiers = [tier for tier in TIERS if any(row.measured and row.tier == tier for row in table.rows)]
    if not tiers:
        return ""
    rows = [[name, *(_leader_cell(table, name, tier) for tier in tiers)] for name in table.scenarios]
    headings = ["scenario", *(f"tier {tier}, {TIERS[tier]}" for tier in tiers)]
    return f"### Least J by tier\n\n{LEADERS}\n\n{markdown_table(headings, rows)}"


def _leader_cell(table: BenchmarkTable, scenario: str, tier: int) -> str:
    first = leader(table.within(scenario), tier)
    if first is None:
        return "–"
    return (
        f"{first.row.controller} {COST.text(first.row.estimates['relative_cost'])}{_unstable(first.row)}{', clearly' * first.clear}"
    )


def _unstable(row: Row) -> str:
    part = row.estimates["unstable"].value
    return f" ({share(part)} unstable)" if part else ""


def agents_and_laws(table: BenchmarkTable) -> str:
    """One of each against the other in each scenario; empty without agents or without laws."""
    rows = [_contest(each) for each in contests(table)]
    if not rows:
        return ""
    headings = ["scenario", "agent", "law", "verdict", "J / J₀, agent less law", "hardest law", "agent less it"]
    return f"### Agents against laws\n\n{RULE}\n\n{markdown_table(headings, rows)}"


def _contest(one: Contest) -> list[str]:
    return [
        one.scenario,
        _name(one.agent, one.agent_chosen),
        _name(one.law, one.law_chosen),
        one.verdict,
        GAP.text(one.gap),
        one.hardest.controller,
        GAP.text(one.least_clear),
    ]


def _name(row: Row, chosen: bool) -> str:
    """In brackets where nobody was chosen."""
    return (row.controller if chosen else f"({row.controller})") + _unstable(row)
