"""What the table answers to the questions it was made for, by rule."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf, isfinite

from beamenv.scenarios.named import UNSEEN
from beamenv.titles import TIERS
from train.benchmark import choice
from train.benchmark.contests import AHEAD, BEHIND, Contest, contests, gap
from train.benchmark.listed import GENERALIST, LEARNT
from train.benchmark.score import SPLITS, split_of
from train.benchmark.table import BenchmarkTable, Row

SINGLE = "single fault"
"""The split that the benchmark's own scenarios are."""

MARGIN = 0.03
"""What a generalist's J may be above that of the best law in a scenario of a single fault."""

UNSTEADY = 0.02
"""The share of episodes that may be unstable where nobody has trained."""


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
    """All of them: what learning buys, who leads in each tier, and how far the generalists reach."""
    told = [claim(table, contests(table)), *(leading(table, tier) for tier in TIERS)]
    return [Finding(each) for each in told if each] + list(_generalists(table))


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


def breadth(table: BenchmarkTable, agent: str) -> Finding:
    """In how many scenarios of a single fault a generalist's J is within 3 % of that of the best law told no more."""
    excess = {
        name: each
        for name in table.scenarios
        if split_of(table, name) == SINGLE and (each := _excess(table, name, agent)) is not None
    }
    beyond = [_beyond(table, name, agent, f"{100.0 * each:+.2f} %") for name, each in excess.items() if each > MARGIN]
    finite = [each for each in excess.values() if isfinite(each)]
    between = f" ({_percent(min(finite))} to {_percent(max(finite))})" if finite else ""
    sentence = (
        f"{agent}: within {100 * MARGIN:.0f} % of the J of the best law told no more, the least on these very seeds, in "
        f"{len(excess) - len(beyond)} of {len(excess)} scenarios of a single fault{between}"
    )
    return Finding(f"{sentence}{', but not in ' if beyond else ''}{', '.join(beyond)}.", not beyond)


def steadiness(table: BenchmarkTable, agent: str) -> Finding:
    """In how many of the scenarios that nobody trains on at most 2 % of a generalist's episodes are unstable."""
    rows = {name: row for name in UNSEEN if split_of(table, name) and (row := table.row(name, agent))}
    shares = {name: row.estimates["unstable"].value if row.measured else inf for name, row in rows.items()}
    beyond = [_beyond(table, name, agent, f"{100.0 * each:.3g} %") for name, each in shares.items() if each > UNSTEADY]
    steady = f"{len(shares) - len(beyond)} of {len(shares)}"
    sentence = f"{agent}: at most {100 * UNSTEADY:.0f} % of episodes unstable in {steady} unseen scenarios"
    return Finding(f"{sentence}{', but not in ' if beyond else ''}{', '.join(beyond)}.", not beyond)


def _excess(table: BenchmarkTable, scenario: str, agent: str) -> float | None:
    """J of an agent over that of the best law told no more, less 1; None where either has nothing to do.

    Infinite where the agent breaks a blade or could not be measured, whatever the law does, and −1 where only the law breaks one.
    """
    row, law = table.row(scenario, agent), best(choice.laws(table.within(scenario)))
    if row is None or law is None:
        return None
    if isfinite(row.mean_cost) and row.mean_cost == law.mean_cost:
        return 0.0
    return row.mean_cost / law.mean_cost - 1.0 if isfinite(row.mean_cost) and law.mean_cost > 0.0 else inf


def _beyond(table: BenchmarkTable, scenario: str, agent: str, by: str) -> str:
    """Where a target is missed, and by how much or why."""
    row = table.row(scenario, agent)
    if row is None or not row.measured:
        return f"{scenario} (not measured)"
    return f"{scenario} {by}" if "inf" not in by else f"{scenario} (a blade breaks)"


def _generalists(table: BenchmarkTable) -> Iterator[Finding]:
    """What there is to say of each agent that is told no more than the scenario's distribution."""
    names = dict.fromkeys(row.controller for row in choice.agents(table.rows) if row.controller.endswith(GENERALIST))
    for name in names:
        if any(_excess(table, each, name) is not None for each in table.scenarios if split_of(table, each) == SINGLE):
            yield breadth(table, name)
        if any(table.row(each, name) for each in UNSEEN if split_of(table, each)):
            yield steadiness(table, name)


def _percent(share: float) -> str:
    return f"{100.0 * share:+.1f} %"
