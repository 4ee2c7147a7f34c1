"""The benchmark and entries of the leaderboard as a terminal shows them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from train.cli.options import print_table, say

if TYPE_CHECKING:
    from train.benchmark.leaderboard import Entry
    from train.benchmark.table import BenchmarkTable, Row

GAP = 2
"""Between columns, and behind the last one."""


def show_table(table: BenchmarkTable, folder: Path) -> None:
    """Two digits of each cell, as many scenarios side by side as the terminal has room for; the files hold the rest."""
    from train.benchmark.targets import findings

    print_costs(table)
    say(f"▲ some episodes unstable. Written to {folder}")
    for each in findings(table):
        say(each.sentence)


def print_costs(table: BenchmarkTable) -> None:
    """J / J₀ of every controller in every scenario."""
    tiers = {row.controller: str(row.tier) for row in table.rows}
    for block in blocks(table, Console().width):
        title = "J / J without control" if block[0] == table.scenarios[0] else None
        shown = Table(title=title, box=box.SIMPLE, padding=(0, 1, 0, 0))
        shown.add_column("controller", no_wrap=True)
        shown.add_column("tier", justify="right")
        for name in block:
            shown.add_column(Text(name), justify="right", no_wrap=True)
        for name in table.controllers:
            shown.add_row(Text(name), tiers[name], *(brief(table.row(scenario, name)) for scenario in block))
        print_table(shown)


def blocks(table: BenchmarkTable, width: int) -> Iterator[tuple[str, ...]]:
    """The scenarios in groups whose columns fit beside the controllers' names; one at least in each."""
    left = 1 + max(len(name) for name in ("controller", *table.controllers)) + GAP + len("tier") + GAP
    block: list[str] = []
    used = left
    for name in table.scenarios:
        needed = GAP + max(len(name), *(len(brief(row)) for row in table.within(name)))
        if block and used + needed > width:
            yield tuple(block)
            block, used = [], left
        block.append(name)
        used += needed
    yield tuple(block)


def brief(row: Row | None) -> str:
    """A cell: a dash where a controller has nothing to do, a cross where it could not be measured."""
    from train.shared.columns import number

    if row is None or not row.measured:
        return "–" if row is None else "✕"
    value = row.estimates["relative_cost"].value
    return number(value, "{:.2f}" if value < 10.0 else "{:.0f}") + ("▲" if row.estimates["unstable"].value else "")


def show_entry(entry: Entry, table: BenchmarkTable, board: Path, folder: Path) -> None:
    """Scenario by scenario beside its references, and the row of the leaderboard."""
    from train.benchmark.leaderboard import NAME, PAGE, cells
    from train.benchmark.score import SPLITS

    shown = Table(title="J / J without control", box=box.SIMPLE, padding=(0, 1, 0, 0))
    shown.add_column("scenario", no_wrap=True)
    names = [name for name in table.controllers if name != "none"]
    for name in names:
        shown.add_column(Text(name), justify="right")
    for scenario in table.scenarios:
        shown.add_row(Text(scenario), *(brief(table.row(scenario, name)) for name in names))
    print_table(shown)
    lines = ["▲ some episodes unstable. ✕ not measured."]
    row = cells(entry)[3:]
    lines += [f"{split}: J / J₀ {row[2 * k]}, score {row[2 * k + 1]}" for k, split in enumerate(SPLITS)]
    lines += [f"unstable: {row[2 * len(SPLITS)]}", f"{entry.name} is on the leaderboard: {board / NAME}, {board / PAGE}"]
    lines += [f"the run: {folder}"]
    for line in lines:
        say(line)


def finite_row(entry: Entry) -> dict[str, Any]:
    """A row as JSON can hold it: None for what is infinite."""
    return {name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in entry.values.items()}
