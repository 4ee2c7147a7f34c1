"""What the table answers to the questions it was made for, by rule."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from baselines import Estimate
from beamenv.knowledge import TIERS
from train.benchmark import statistics
from train.benchmark.listed import GENERALIST
from train.benchmark.table import RIVAL, BenchmarkTable, Row

NOMINAL = "nominal"
MARGIN = 0.03


@dataclass(frozen=True, slots=True)
class Finding:
    """A sentence, and whether it meets the target; None where there is none."""

    sentence: str
    met: bool | None = None


def findings(table: BenchmarkTable) -> list[Finding]:
    """All of them: the generalists where LQG is at home, the best agent against who is told no more, and who wins in each tier."""
    found = [nominal(each, rival) for each, rival in _generalists(table)]
    others = [name for name in table.scenarios if name != NOMINAL]
    contests = [contest for name in others if (contest := _contest(table.within(name)))]
    if contests:
        ahead = [agent.scenario for agent, _, gap in contests if gap.high < 0.0]
        where = f"{len(ahead)} of {len(contests)} scenarios besides nominal{': ' if ahead else ''}{', '.join(ahead)}"
        found.append(Finding(f"The best agent is ahead of the best other controller that is told no more in {where}."))
        found += [Finding(_sentence(*contest)) for contest in contests]
    return found + [Finding(sentence) for name in table.scenarios for sentence in winners(table.within(name))]


def nominal(agent: Row, rival: Row) -> Finding:
    """Whether a generalist is within 3 % of LQG under the nominal plant, by the ratio of mean costs."""
    assert agent.cost is not None and rival.cost is not None
    excess = statistics.ratio(agent.cost, rival.cost)
    sentence = (
        f"{agent.controller} on nominal: J differs from LQG's by {_percent(excess.value - 1.0)} "
        f"[{_percent(excess.low - 1.0)}, {_percent(excess.high - 1.0)}]; target: at most {_percent(MARGIN)}."
    )
    return Finding(sentence, excess.value <= 1.0 + MARGIN)


def best(rows: Iterable[Row]) -> Row | None:
    """The least mean J; None if none of them was measured."""
    return min((row for row in rows if row.measured), key=lambda row: row.mean_cost, default=None)


def winners(rows: Sequence[Row]) -> list[str]:
    """Who has the least mean J of each tier, whatever its kind, and how far ahead of LQG."""
    return [sentence for tier in TIERS if (sentence := _winner([row for row in rows if row.tier == tier]))]


def _winner(rows: Sequence[Row]) -> str:
    """Empty without one."""
    first = best(rows)
    gap = first.estimates.get("difference_to_lqg") if first else None
    if first is None or gap is None:
        return ""
    where = f"{first.scenario}, tier {first.tier}"
    if first.mean_cost == float("inf"):
        return f"{where}: every controller breaks blades."
    unstable = first.estimates["unstable"].value
    doubt = f"; unstable in {100.0 * unstable:.0f} % of its episodes" if unstable else ""
    return f"{where}: lowest J by {first.controller} ({first.kind}), {_gap(gap)} against LQG{doubt}."


def _generalists(table: BenchmarkTable) -> list[tuple[Row, Row]]:
    rival = table.row(NOMINAL, RIVAL)
    rows = [row for row in table.within(NOMINAL) if row.controller.endswith(GENERALIST) and row.measured]
    return [(row, rival) for row in rows] if rival is not None and rival.measured else []


def _contest(rows: Sequence[Row]) -> tuple[Row, Row, Estimate] | None:
    """Best agent, the best of all others that are told no more than it, and the paired difference of their relative costs."""
    agent = best(row for row in rows if row.kind == "learned")
    rival = best(row for row in rows if row.kind != "learned" and agent is not None and row.tier <= agent.tier)
    if agent is None or rival is None:
        return None
    assert agent.cost is not None and rival.cost is not None and rival.uncontrolled is not None
    return agent, rival, statistics.difference(agent.cost, rival.cost, rival.uncontrolled)


def _sentence(agent: Row, rival: Row, gap: Estimate) -> str:
    verdict = "ahead" if gap.high < 0.0 else "behind" if gap.low > 0.0 else "no clear difference"
    rivals = f"best agent {agent.controller}, best other {rival.controller} (tier {rival.tier})"
    return f"{agent.scenario}: {rivals}: {_gap(gap)}, {verdict}."


def _gap(gap: Estimate) -> str:
    return f"J / J without control {gap.value:+.3f} [{gap.low:+.3f}, {gap.high:+.3f}]"


def _percent(share: float) -> str:
    return f"{100.0 * share:+.1f} %"
