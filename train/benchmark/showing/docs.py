"""The last full run as a page of the documentation: definitions, findings, and folded all that was measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from beamenv.configuration.writing import write_whole
from train.benchmark.contests import contests
from train.benchmark.score import by_split
from train.benchmark.showing.contests import agents_and_laws, leaders
from train.benchmark.showing.findings import findings_table
from train.benchmark.showing.heat_map import RULE, heat_map
from train.benchmark.showing.legend import details, terms
from train.benchmark.showing.report import overview, scenario_table
from train.benchmark.showing.scores import headroom, scores
from train.benchmark.table import BenchmarkTable
from train.figures.paper import save_themes
from train.figures.paper_heat_map import heat_map as drawn
from train.shared.markdown import escaped, folded
from train.shared.markdown import table as markdown_table

INTRODUCTION = """\
# The benchmark

Every controller in every scenario, on the same held-out episodes. [What learning buys](agents.md#what-learning-buys), and what it
does not, is told beside the agents.

- **Scenarios** are files in `beamenv/scenarios/named/`, in three splits. A *single fault* scenario has one thing wrong. In an
  *open* scenario the blade changes within the episode, or everything is wrong at once. *Unseen* scenarios are kept for judging: no
  agent trains on them by themselves, and nothing is chosen by them. Development did look at agents there. Their pairs of faults
  are of no new kinds: `unknown-everything`, an open scenario that agents train on, has all these kinds at once, each mildly.
- **Controllers** are files in `train/controllers/named/`. Each is built from what its tier of information is told. *Agents* learn
  on the scenarios' distributions, and are used as shipped: a *generalist* trained on all scenarios but the unseen ones, a
  *specialist* on the one that it is measured in. All others are *classical*.
- **Yours**: a further file in either folder adds a row or a column. `beamenv benchmark --submit mine` puts a trained agent of
  yours through every scenario and enters it on the [leaderboard](leaderboard.md).
"""
PICTURE = "![J / J₀ of controllers in every scenario; lower is better](images/benchmark.png)"
"""On dark pages ``benchmark-dark.png``, which lies beside it."""
LIMITS = """\
## What the comparison does not say

- **Of agents that learn by trial and error: nothing.** None is in the table. The runs of PPO and SAC that
  [ship](learning.md#ppo-and-sac) learnt `nominal` alone, from 0.7 to 4.4 million control intervals, in four minutes of a core at
  most. That is small; what ten or a hundred times as much would bring was not tried.
- **Of classical controllers at their best: little.** The classical controller that was chosen for unseen scenarios,
  `multiple-model-general`, has a bank of 64 models at most, made of the files of the scenarios that agents train on too. Agents
  have besides met mixtures of faults drawn at random. A bank that holds such mixtures could close part of the gap; none has been
  built.
- **Of other blades: nothing.** All scenarios move one blade, or plants drawn about it, in simulation.
"""
FOLDED = "The tables are folded: a click opens one. An agent has a row for all its training runs together."


def write_docs(folder: Path, table: BenchmarkTable, command: str) -> None:
    """``benchmark.md`` with its heat map in ``images/``, for light and for dark pages."""
    content = heat_map(table)
    save_themes(lambda theme: drawn(content, theme), folder / "images" / "benchmark.png")
    write_whole(folder / "benchmark.md", page(table, command))


def page(table: BenchmarkTable, command: str) -> str:
    """The page: what the words mean, findings and picture, what they rest on, and folded the numbers."""
    parts = [
        INTRODUCTION.strip(),
        definitions(table),
        findings_table(table).markdown(2),
        f"{PICTURE}\n\n{RULE}",
        *(section(table).markdown(2) for section in (agents_and_laws, leaders, scores, headroom)),
        LIMITS.strip() if contests(table) else "",
        f"## All numbers\n\n{FOLDED}",
        *overviews(table),
        *scenarios(table),
        *remarks("What was left out", [escaped(each) for each in table.left_out]),
        *remarks("What went wrong", [f"{escaped(where)}: {escaped(told)}" for where, told in table.sentences.items()]),
        f"## How it was made\n\n```sh\n{command}\n```\n\nwith {in_a_line(table.configuration['versions'])}.",
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def definitions(table: BenchmarkTable) -> str:
    """What the words mean, as a table; what only who looks closer needs is folded."""
    more = folded("Further words and rules", _dictionary(details()))
    return f"## What the words mean\n\n{_dictionary(terms(table))}\n\n{more}"


def _dictionary(meanings: Mapping[str, str]) -> str:
    return markdown_table(["word", "meaning"], list(meanings.items()))


def overviews(table: BenchmarkTable) -> list[str]:
    """J / J₀ of every controller in every scenario, a folded table for each split."""
    splits = by_split(table)
    names = {split: [name for name, each in splits.items() if each == split] for split in dict.fromkeys(splits.values())}
    return [folded(f"J / J₀: {split}, {len(found)} scenarios", overview(table, found)) for split, found in names.items()]


def scenarios(table: BenchmarkTable) -> list[str]:
    """Every estimate, a folded table for each scenario."""
    return [folded(f"Every estimate: {name}", scenario_table(table.within(name))) for name in table.scenarios]


def remarks(heading: str, lines: Sequence[str]) -> list[str]:
    """A folded list; nothing without any."""
    return [folded(heading, "\n".join(f"- {line}" for line in lines))] if lines else []


def in_a_line(versions: Mapping[str, str]) -> str:
    """Versions in a line."""
    return ", ".join(f"{name} {version}" for name, version in versions.items())
