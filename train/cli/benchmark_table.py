"""The benchmark and entries of the leaderboard as a terminal shows them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from train.cli.options import say
from train.cli.tables import Column, show_table

if TYPE_CHECKING:
    from train.benchmark.leaderboard import Entry
    from train.benchmark.table import BenchmarkTable, Row

MARKS = {
    "▲": "▲ some episodes unstable.",
    "✕": "✕ not measured.",
    "–": "– nothing to do there.",
}
"""What a cell may hold besides its number, and what is said of it where one does."""


def show_benchmark(table: BenchmarkTable, folder: Path) -> None:
    """Two digits of each cell, as many scenarios side by side as the terminal has room for; the files hold the rest."""
    from train.benchmark.targets import findings

    print_costs(table)
    say(f"written to {folder}")
    for each in findings(table):
        say(each.sentence)


def print_costs(table: BenchmarkTable) -> None:
    """J / J₀ of every controller in every scenario."""
    tiers = {row.controller: str(row.tier) for row in table.rows}
    columns = [Column("controller", words=True), Column("tier"), *(Column(heading(name)) for name in table.scenarios)]
    rows = [[name, tiers[name], *(brief(table.row(each, name)) for each in table.scenarios)] for name in table.controllers]
    show_table(columns, rows, "J / J without control")
    tell_marks(rows)


def heading(name: str) -> str:
    """A scenario's or controller's name on as many lines as it has words: many fit beside each other."""
    return name.replace("-", "-\n")


def tell_marks(rows: Sequence[Sequence[str]]) -> None:
    """What the marks in a table say, of those that are there."""
    if told := [sentence for mark, sentence in MARKS.items() if any(mark in cell for row in rows for cell in row[1:])]:
        say(" ".join(told))


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

    names = [name for name in table.controllers if name != "none"]
    rows = [[each, *(brief(table.row(each, name)) for name in names)] for each in table.scenarios]
    show_table([Column("scenario", words=True), *(Column(heading(name)) for name in names)], rows, "J / J without control")
    tell_marks(rows)
    row = cells(entry)[3:]
    lines = [f"{split}: J / J₀ {row[2 * k]}, score {row[2 * k + 1]}" for k, split in enumerate(SPLITS)]
    lines += [f"unstable: {row[2 * len(SPLITS)]}", f"{entry.name} is on the leaderboard: {board / NAME}, {board / PAGE}"]
    lines += [f"the run: {folder}"]
    for line in lines:
        say(line)


def finite_row(entry: Entry) -> dict[str, Any]:
    """A row as JSON can hold it: None for what is infinite."""
    return {name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in entry.values.items()}
