"""What the table answers, as one table: questions down, splits of scenarios across."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from beamenv.titles import TIERS
from train.benchmark.contests import AHEAD, BEHIND, contests
from train.benchmark.score import by_split, split_of
from train.benchmark.showing.section import Entry, Section, words
from train.benchmark.table import BenchmarkTable
from train.benchmark.targets import Leader, ahead_and_behind, leaders_of, reaches

TEXT = (
    "Agents are the learned controllers of tier 1, which are told no more than the scenario's distribution. They are compared with "
    "the classical controllers of tiers 0 and 1, and the best of these is the one with the least J on these very seeds. Ahead, "
    "behind and clearly mean by the paired interval. Who leads a tier does so clearly, or is alone in it, unless the table says "
    "otherwise."
)
NOTHING = "–"


def findings_table(table: BenchmarkTable) -> Section:
    """Agents against classical controllers, how far generalists reach, and who leads each tier."""
    splits = list(dict.fromkeys(by_split(table).values()))
    rows = [*_ahead(table, splits), *_reaches(table, splits), *_leaders(table, splits)]
    said = ahead_and_behind(table, contests(table), named=False)
    text = f"{said[0].upper()}{said[1:]}.\n\n{TEXT}" if said else TEXT
    return Section("Findings", text, ["question", *splits], rows, len(splits) + 1)


def _ahead(table: BenchmarkTable, splits: Sequence[str]) -> Iterator[list[Entry]]:
    """In how many scenarios of each split the agent is ahead of all, and behind."""
    verdicts: dict[str, list[str]] = {}
    for each in contests(table):
        verdicts.setdefault(split_of(table, each.scenario) or "other", []).append(each.verdict)
    if verdicts:
        told = {name: f"ahead in {v.count(AHEAD)} of {len(v)}, behind in {v.count(BEHIND)}" for name, v in verdicts.items()}
        yield _row("Is the chosen agent ahead of every classical controller?", splits, told)


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
    return ", ".join(f"{name} in {len(each)}{_how(each)}" for name, each in ranked)


def _how(leaders: Sequence[Leader]) -> str:
    """In how many of them clearly, where it is not in all; nothing of who is alone, which the text explains."""
    clear = sum(each.clear for each in leaders)
    return "" if clear == len(leaders) or not any(each.rivals for each in leaders) else f" (clearly in {clear})"


def _row(question: str, splits: Sequence[str], cells: Mapping[str, str]) -> list[Entry]:
    return words(question, *(cells.get(split, NOTHING) for split in splits))
