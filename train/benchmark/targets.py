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
    return [Finding(each) for each in told if each] + [each.finding for each in reaches(table)]


def claim(table: BenchmarkTable, found: Sequence[Contest]) -> str:
    """In which scenarios the agent is ahead of all classical controllers that are told no more, and behind; empty without any."""
    said = ahead_and_behind(table, found, named=True)
    return f"Tier {LEARNT} and below, by paired intervals of J: {said}." if said else ""


def ahead_and_behind(table: BenchmarkTable, found: Sequence[Contest], named: bool) -> str:
    """In how many scenarios of each split, ``named`` or not; empty without any."""
    if not found:
        return ""
    by_split = {split: [each for each in found if split_of(table, each.scenario) == split] for split in (*SPLITS, "")}
    parts = [_of_split(split, those, named) for split, those in by_split.items() if those]
    agent = (
        "the agent chosen on validation seeds"
        if all(each.agent_chosen for each in found)
        else (
            "the agent chosen on validation seeds (where none was, the one with the least J on these very seeds, which favours it)"
        )
    )
    return f"{agent} is ahead of every classical controller in {'; in '.join(parts)}"


def _of_split(split: str, found: Sequence[Contest], named: bool) -> str:
    ahead, behind = ([each.scenario for each in found if each.verdict == verdict] for verdict in (AHEAD, BEHIND))
    which = [f" ({', '.join(names)})" if names and named else "" for names in (ahead, behind)]
    return f"{len(ahead)} of {len(found)} {split or 'other'} scenarios{which[0]}, behind in {len(behind)}{which[1]}"


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


@dataclass(frozen=True, slots=True)
class Reach:
    """In how many scenarios of a split a generalist meets a target."""

    agent: str
    goal: str
    split: str
    scenarios: int
    span: str
    """From the least to the most that was found; empty where nothing is finite, or not asked for."""
    beyond: tuple[str, ...]
    """Where it misses it, and by how much or why."""

    @property
    def met(self) -> bool:
        """Whether it does so in all of them."""
        return not self.beyond

    @property
    def share(self) -> str:
        """In how many of how many, as "8 of 10"."""
        return f"{self.scenarios - len(self.beyond)} of {self.scenarios}"

    @property
    def finding(self) -> Finding:
        """In a sentence."""
        where = f"scenarios of a {self.split}" if self.split == SINGLE else f"{self.split} scenarios"
        span, but = f" ({self.span})" if self.span else "", ", but not in " if self.beyond else ""
        return Finding(f"{self.agent}: {self.goal} in {self.share} {where}{span}{but}{', '.join(self.beyond)}.", self.met)


def breadth(table: BenchmarkTable, agent: str) -> Reach:
    """In how many scenarios of a single fault a generalist's J is within 3 % of that of the best law told no more."""
    excess = {
        name: each
        for name in table.scenarios
        if split_of(table, name) == SINGLE and (each := _excess(table, name, agent)) is not None
    }
    beyond = [_beyond(table, name, agent, f"{100.0 * each:+.2f} %") for name, each in excess.items() if each > MARGIN]
    finite = [each for each in excess.values() if isfinite(each)]
    span = f"{_percent(min(finite))} to {_percent(max(finite))}" if finite else ""
    goal = f"J within {100 * MARGIN:.0f} % of the best classical controller's"
    return Reach(agent, goal, SINGLE, len(excess), span, tuple(beyond))


def steadiness(table: BenchmarkTable, agent: str) -> Reach:
    """In how many of the scenarios that nobody trains on at most 2 % of a generalist's episodes are unstable."""
    rows = {name: row for name in UNSEEN if split_of(table, name) and (row := table.row(name, agent))}
    shares = {name: row.estimates["unstable"].value if row.measured else inf for name, row in rows.items()}
    beyond = [_beyond(table, name, agent, f"{100.0 * each:.3g} %") for name, each in shares.items() if each > UNSTEADY]
    return Reach(agent, f"at most {100 * UNSTEADY:.0f} % of episodes unstable", "unseen", len(shares), "", tuple(beyond))


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


def reaches(table: BenchmarkTable) -> Iterator[Reach]:
    """How far each generalist reaches that is told no more than the scenario's distribution."""
    names = dict.fromkeys(row.controller for row in choice.agents(table.rows) if row.controller.endswith(GENERALIST))
    for name in names:
        if any(_excess(table, each, name) is not None for each in table.scenarios if split_of(table, each) == SINGLE):
            yield breadth(table, name)
        if any(table.row(each, name) for each in UNSEEN if split_of(table, each)):
            yield steadiness(table, name)


def _percent(share: float) -> str:
    return f"{100.0 * share:+.1f} %"
