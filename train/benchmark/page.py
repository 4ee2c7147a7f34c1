"""The benchmark as one page that needs no network."""

from __future__ import annotations

from pathlib import Path

from train.benchmark.heat_map import columns, relative_costs, unstable_shares
from train.benchmark.report import COLUMNS, legend, text
from train.benchmark.table import BenchmarkTable, Row
from train.benchmark.targets import findings
from train.page import Cell, HeatMap, PageContent, Table, write_page


def write_report(path: Path, table: BenchmarkTable) -> None:
    """Findings, heat map, every row, what went wrong, and the configuration."""
    wrong = [f"{where}: {sentence}" for where, sentence in table.sentences.items()]
    content = PageContent(
        title="Controllers of a rotating blade across scenarios",
        note=" ".join([*(each.sentence for each in findings(table)), *wrong]),
        table=page_table(table),
        heat_map=HeatMap(table.scenarios, columns(table), relative_costs(table), unstable_shares(table)),
        configuration=table.configuration,
    )
    write_page(path, content)


def page_table(table: BenchmarkTable) -> Table:
    """All rows, to be sorted by a click."""
    headings = ("scenario", "controller", "kind", "runs", *(heading for _, heading, *_ in COLUMNS))
    return Table(headings, tuple(_cells(row) for row in table.rows), legend(table))


def _cells(row: Row) -> tuple[Cell, ...]:
    about = (Cell(row.scenario), Cell(row.title), Cell(row.kind), Cell(str(row.runs), row.runs))
    found = ((row.estimates.get(name), factor, form, wide) for name, _, factor, form, wide in COLUMNS)
    return about + tuple(Cell(text(each, *how), None if each is None else each.value) for each, *how in found)
