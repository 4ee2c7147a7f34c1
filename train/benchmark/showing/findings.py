"""What the table answers, as one table: questions down, splits of scenarios across."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from beamenv.titles import TIERS
from train.benchmark.contests import AHEAD, BEHIND, Contest, contests, corrected
from train.benchmark.score import by_split, split_of
from train.benchmark.showing.section import Entry, Section, in_words, words
from train.benchmark.table import BenchmarkTable
from train.benchmark.targets import Leader, ahead_and_behind, leaders_of, reaches

TEXT = (
    "Agents are the learned controllers of tier 1, which are told no more than the scenario's distribution. They are compared with "
    "the classical controllers of tiers 0 and 1. What is compared with what, each by the paired interval:\n\n"
    "- Ahead: the chosen agent with every classical controller, also with those that nobody would have chosen.\n"
    "- Behind: the chosen classical controller with every agent.\n"
    "- Overtaken: the chosen agent with every classical controller again; one at least is below it. Which one is seen on these "
    "very seeds only, so that an agent can be overtaken and not be behind.\n"
    "- The best classical controller of a target is the one with the least J on these very seeds.\n"
    "- Who has the least J of a tier is below every other of it, or the only one, unless the table says in how many scenarios this "
    "is clear."
)
TOGETHER = (
    "The intervals hold for one scenario at a time. Where all {scenarios} scenarios are judged together, at 5 % by Holm's method, "
    "the agent is ahead in {ahead} and behind in {behind}."
)
NOTHING = "–"


def findings_table(table: BenchmarkTable) -> Section:
    """Agents against classical controllers, how far generalists reach, and who leads each tier."""
    splits = list(dict.fromkeys(by_split(table).values()))
    rows = [*_ahead(table, splits), *_reaches(table, splits), *_leaders(table, splits)]
    said = ahead_and_behind(table, contests(table), named=False)
    text = f"{said[0].upper()}{said[1:]}.\n\n{_together(table)}\n\n{TEXT}" if said else TEXT
    return Section("Findings", text, ["question", *splits], rows, len(splits) + 1)


def _ahead(table: BenchmarkTable, splits: Sequence[str]) -> Iterator[list[Entry]]:
    """In how many scenarios of each split the agent is ahead of all, behind, and overtaken by any."""
    found: dict[str, list[Contest]] = {}
    for each in contests(table):
        found.setdefault(split_of(table, each.scenario) or "other", []).append(each)
    if found:
        verdicts = {name: [each.verdict for each in those] for name, those in found.items()}
        told = {name: f"ahead in {v.count(AHEAD)} of {len(v)}, behind in {v.count(BEHIND)}" for name, v in verdicts.items()}
        yield _row("Is the chosen agent ahead of every classical controller?", splits, told)
        overtaken = {name: f"in {sum(each.overtaken for each in those)} of {len(those)}" for name, those in found.items()}
        yield _row("Is it overtaken by any of them?", splits, overtaken)


def _together(table: BenchmarkTable) -> str:
    """How many verdicts are left when all scenarios are judged together."""
    left = corrected(contests(table))
    return TOGETHER.format(scenarios=len(left), ahead=left.count(AHEAD), behind=left.count(BEHIND))


def _reaches(table: BenchmarkTable, splits: Sequence[str]) -> Iterator[list[Entry]]:
    """What was asked of each generalist in a split, in how many scenarios it does it, and whether that is the target."""
    asked: dict[str, dict[str, str]] = {}
    for each in reaches(table):
        more = f" ({each.span})" if each.span else f", but not {', '.join(each.beyond)}" if each.beyond else ""
        told = f"{each.goal} in {each.share}{more}: {'met' if each.met else 'missed'}"
        asked.setdefault(each.agent, {})[each.split] = told
    for agent, cells in asked.items():
        yield _row(f"Does {agent} meet its targets?", splits, cells)


def _leaders(table: BenchmarkTable, splits: Sequence[str]) -> Iterator[list[Entry]]:
    """Who has the least J of a tier in how many scenarios of each split."""
    of_scenario = by_split(table)
    for tier, told in TIERS.items():
        found: dict[str, list[Leader]] = {}
        for (name, place), each in leaders_of(table).items():
            if place == tier:
                found.setdefault(of_scenario[name], []).append(each)
        if found:
            yield _row(f"Who has the least J of tier {tier}, {told}?", splits, {name: _won(won) for name, won in found.items()})


def _won(leaders: Sequence[Leader]) -> str:
    """The names, those that win most first, with in how many scenarios."""
    wins: dict[str, list[Leader]] = {}
    for each in leaders:
        wins.setdefault(each.row.controller, []).append(each)
    ranked = sorted(wins.items(), key=lambda item: -len(item[1]))
    return ", ".join(f"{in_words(name)} in {len(each)}{_how(each)}" for name, each in ranked)


def _how(leaders: Sequence[Leader]) -> str:
    """In how many of them clearly, where it is not in all; nothing of who is alone, which the text explains."""
    clear = sum(each.clear for each in leaders)
    return "" if clear == len(leaders) or not any(each.rivals for each in leaders) else f" (clearly in {clear})"


def _row(question: str, splits: Sequence[str], cells: Mapping[str, str]) -> list[Entry]:
    return words(question, *(cells.get(split, NOTHING) for split in splits))
