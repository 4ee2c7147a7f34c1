"""Agents against laws that are told no more, scenario by scenario; who stands for them is chosen on other seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from baselines import Estimate
from train.benchmark import choice, statistics
from train.benchmark.cells import sources_digest
from train.benchmark.choice import Choice
from train.benchmark.table import BenchmarkTable, Row

AHEAD, BEHIND, LEVEL = "ahead", "behind", "not told apart"

RULE = (
    "In each scenario one agent and one classical controller stand for their kind. Both were chosen beforehand, on validation "
    "seeds, which are other seeds than these: by the least mean J. In unseen scenarios, on which nothing may be chosen, by the "
    "least interquartile mean of J / J₀ over the others, among those that are the same everywhere: a controller made from what "
    "it is told of a scenario is told nothing there. A name in brackets was not chosen: it has the least J on these very seeds, "
    "which favours it.\n\n"
    "Ahead: the agent's J is below that of every classical controller told no more. Behind: the J of the chosen classical "
    "controller is below that of every agent. Each by the paired interval, which is not corrected for the number of scenarios. "
    "The column beside it has the verdict that is left when all scenarios are judged together, at 5 % by Holm's method. The "
    "hardest is the classical controller that the agent is least clearly ahead of. Where its whole interval is above zero, it has "
    "overtaken the agent: that makes no verdict by itself, because which controller does so is seen on these very seeds only."
)
"""How agents and laws are compared, for whoever shows it."""


STALE = (
    "The choice was made by an earlier version of the code, or with other versions of NumPy and SciPy; "
    "`python -m train.benchmark.choose` makes it again."
)


def rule() -> str:
    """``RULE``, and whether today's code is that which the choice was made with."""
    made = choice.read_choice()
    return RULE if made is None or made.digest == sources_digest() else f"{RULE} {STALE}"


@dataclass(frozen=True, slots=True)
class Contest:
    """One scenario."""

    scenario: str
    agent: Row
    law: Row
    agent_chosen: bool
    """Whether on validation seeds; else it is the least mean J on the seeds that it is judged on."""
    law_chosen: bool
    gap: Estimate
    """J / J₀ of the agent less the law's, in pairs."""
    hardest: Row
    """The law that the agent is least clearly ahead of."""
    least_clear: Estimate
    """J / J₀ of the agent less that law's."""
    overtaken: bool
    """Whether any law is below the agent, by the paired interval."""
    verdict: str
    doubt: float
    """p value of the pair that the verdict hangs on; 1 where there is none."""


@lru_cache(maxsize=1)
def contests(table: BenchmarkTable) -> tuple[Contest, ...]:
    """Of every scenario with an agent and a law, by the choice that ships."""
    return contests_by(table, choice.read_choice())


def contests_by(table: BenchmarkTable, chosen: Choice | None) -> tuple[Contest, ...]:
    """The same by another choice, None for nobody chosen."""
    found = (_contest(name, table.within(name), chosen) for name in table.scenarios)
    return tuple(each for each in found if each is not None)


def _contest(scenario: str, rows: Sequence[Row], chosen: Choice | None) -> Contest | None:
    agents, laws = choice.agents(rows), choice.laws(rows)
    if not agents or not laws:
        return None
    agent, agent_chosen = _champion(agents, "" if chosen is None else chosen.name("agents", scenario))
    law, law_chosen = _champion(laws, "" if chosen is None else chosen.name("laws", scenario))
    gaps = [(other, gap(agent, other)) for other in laws]
    hardest, least_clear = max(gaps, key=lambda each: each[1].high)
    nearest, least_behind = min(((other, gap(other, law)) for other in agents), key=lambda each: each[1].low)
    verdict = AHEAD if least_clear.high < 0.0 else BEHIND if least_behind.low > 0.0 else LEVEL
    pair = {AHEAD: (agent, hardest), BEHIND: (nearest, law)}.get(verdict)
    return Contest(
        scenario,
        agent,
        law,
        agent_chosen,
        law_chosen,
        gap(agent, law),
        hardest,
        least_clear,
        any(each.low > 0.0 for _, each in gaps),
        verdict,
        1.0 if pair is None else _doubt(*pair),
    )


def corrected(found: Sequence[Contest]) -> list[str]:
    """The verdicts that are left when all scenarios are judged together."""
    holds = statistics.rejected([each.doubt for each in found])
    return [each.verdict if held else LEVEL for each, held in zip(found, holds, strict=True)]


def _doubt(row: Row, other: Row) -> float:
    assert row.cost is not None and other.cost is not None
    return statistics.doubt(row.cost, other.cost)


def _champion(rows: Sequence[Row], name: str) -> tuple[Row, bool]:
    """Who was chosen, or else the least mean J."""
    named = next((row for row in rows if row.controller == name), None)
    return (named, True) if named else (min(rows, key=lambda row: row.mean_cost), False)


def gap(row: Row, other: Row) -> Estimate:
    """The paired difference of relative costs."""
    assert row.cost is not None and other.cost is not None and other.uncontrolled is not None
    return statistics.difference(row.cost, other.cost, other.uncontrolled)
