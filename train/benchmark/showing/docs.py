"""The last full run as a page of the documentation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from beamenv.configuration.writing import write_whole
from train.benchmark.showing.heat_map import RULE, heat_map
from train.benchmark.showing.report import markdown
from train.benchmark.table import BenchmarkTable
from train.figures.paper import save_themes
from train.figures.paper_heat_map import heat_map as drawn

INTRODUCTION = """\
# The benchmark

Every controller in every scenario on the same held-out episodes. Controllers are built from what their tier of information is told,
and agents, which train on the scenario's distribution, are used as shipped. The scenarios are files in `beamenv/scenarios/named/`:
those with a single fault, open ones, in which the blade changes within the episode or everything is wrong at once, and those kept
for judging, which no agent trains on by themselves and by which nothing is chosen, though development looked at agents there.
Their pairs of faults are of no new kinds: `unknown-everything`, an open one, by its definition puts all of these kinds together,
each mildly, and agents train on it by today's recipes. The controllers are files in `train/controllers/named/`: a further file in
either folder adds a row or a column.

[What learning buys](agents.md#what-learning-buys), and what it does not, is told beside the agents. `beamenv benchmark --submit
mine` puts a trained agent of yours through every scenario and enters it on the [leaderboard](leaderboard.md).
"""


def write_docs(folder: Path, table: BenchmarkTable, command: str) -> None:
    """``benchmark.md`` with its heat map in ``images/``, for light and for dark pages."""
    content = heat_map(table)
    save_themes(lambda theme: drawn(content, theme), folder / "images" / "benchmark.png")
    write_whole(folder / "benchmark.md", page(table, command))


def page(table: BenchmarkTable, command: str) -> str:
    """The page: how it was made, the picture, and the table."""
    made = f"Made by\n\n```sh\n{command}\n```\n\nwith {in_a_line(table.configuration['versions'])}."
    return f"{INTRODUCTION}\n{made}\n\n![J over J without control](images/benchmark.png)\n\n{RULE}\n\n{markdown(table)}"


def in_a_line(versions: Mapping[str, str]) -> str:
    """Versions in a line."""
    return ", ".join(f"{name} {version}" for name, version in versions.items())
