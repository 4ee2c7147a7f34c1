"""What the table answers to the questions it was made for, by rule."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from beamenv.knowledge import TIERS
from train.benchmark import statistics
from train.benchmark.contests import AHEAD, BEHIND, Contest, contests, gap
from train.benchmark.listed import GENERALIST, LEARNT
from train.benchmark.score import SPLITS, split_of
from train.benchmark.table import RIVAL, BenchmarkTable, Row

NOMINAL = "nominal"
MARGIN = 0.03


@dataclass(frozen=True, slots=True)
class Finding:
    """A sentence, and whether it meets the target; None where there is none."""

    sentence: str
    met: bool | None = None


@dataclass(frozen=True, slots=True)
class Leader:
    """Who has the least mean J of a tier in a scenario, of all kinds."""

    row: Row
    rivals: int
    """Others of the tier that were measured there."""
    clear: bool
    """Whether it is below every one of these, each by the paired interval."""


def findings(table: BenchmarkTable) -> list[Finding]:
    """All of them: what learning buys, who leads in each tier, and the generalists where LQG is at home."""
    told = [claim(table, contests(table)), *(leading(table, tier) for tier in TIERS)]
    return [Finding(each) for each in told if each] + [nominal(agent, rival) for agent, rival in _generalists(table)]


def claim(table: BenchmarkTable, found: Sequence[Contest]) -> str:
    """In how many scenarios of each split the agent is ahead of all laws that are told no more, and behind; empty without any."""
    if not found:
        return ""
    parts = [
        part for split in (*SPLITS, "") if (part := _of_split(split, [c for c in found if split_of(table, c.scenario) == split]))
    ]
    agent = (
        "the agent chosen on validation seeds"
        if all(each.agent_chosen for each in found)
        else (
            "the agent, where none was chosen on validation seeds the one with the least J on these very seeds, which favours it,"
        )
    )
    return f"Tier {LEARNT} and below, by paired intervals of J: {agent} is ahead of every law in {'; in '.join(parts)}."


def _of_split(split: str, found: Sequence[Contest]) -> str:
    """Empty where there is no contest."""
    if not found:
        return ""
    ahead, behind = ([each.scenario for each in found if each.verdict == verdict] for verdict in (AHEAD, BEHIND))
    return f"{len(ahead)} of {len(found)} {split or 'other'} scenarios{_listed(ahead)}, behind in {len(behind)}{_listed(behind)}"


def _listed(names: Sequence[str]) -> str:
    return f" ({', '.join(names)})" if names else ""


def leading(table: BenchmarkTable, tier: int) -> str:
    """Who has the least mean J of a tier in how many scenarios, and in how many clearly; empty without anyone."""
    leaders = [each for (_, place), each in leaders_of(table).items() if place == tier]
    wins: dict[str, list[Leader]] = {}
    for each in leaders:
        wins.setdefault(each.row.controller, []).append(each)
    parts = [f"{name} in {_won(each)}" for name, each in sorted(wins.items(), key=lambda item: -len(item[1]))]
    return f"Tier {tier}, {TIERS[tier]}: least J of {len(leaders)} scenarios by {'; '.join(parts)}." if parts else ""


def _won(leaders: Sequence[Leader]) -> str:
    if not any(each.rivals for each in leaders):
        return f"{len(leaders)}, alone"
    return f"{len(leaders)}, clearly in {sum(each.clear for each in leaders)}"


@lru_cache(maxsize=1)
def leaders_of(table: BenchmarkTable) -> dict[tuple[str, int], Leader]:
    """By scenario and tier."""
    found = {(name, tier): leader(table.within(name), tier) for name in table.scenarios for tier in TIERS}
    return {place: each for place, each in found.items() if each is not None}


def leader(rows: Sequence[Row], tier: int) -> Leader | None:
    """Of a tier in one scenario; None if nobody of it was measured."""
    own = [row for row in rows if row.measured and row.tier == tier]
    first = best(own)
    if first is None:
        return None
    others = [row for row in own if row is not first]
    return Leader(first, len(others), bool(others) and all(gap(first, other).high < 0.0 for other in others))


def best(rows: Iterable[Row]) -> Row | None:
    """The least mean J; None if none of them was measured."""
    return min((row for row in rows if row.measured), key=lambda row: row.mean_cost, default=None)


def nominal(agent: Row, rival: Row) -> Finding:
    """Whether a generalist is within 3 % of LQG under the nominal plant, by the ratio of mean costs."""
    assert agent.cost is not None and rival.cost is not None
    excess = statistics.ratio(agent.cost, rival.cost)
    sentence = (
        f"{agent.controller} on nominal: J differs from LQG's by {_percent(excess.value - 1.0)} "
        f"[{_percent(excess.low - 1.0)}, {_percent(excess.high - 1.0)}]; target: at most {_percent(MARGIN)}."
    )
    return Finding(sentence, excess.value <= 1.0 + MARGIN)


def _generalists(table: BenchmarkTable) -> list[tuple[Row, Row]]:
    rival = table.row(NOMINAL, RIVAL)
    rows = [row for row in table.within(NOMINAL) if row.controller.endswith(GENERALIST) and row.measured]
    return [(row, rival) for row in rows] if rival is not None and rival.measured else []


def _percent(share: float) -> str:
    return f"{100.0 * share:+.1f} %"
