"""The benchmark as one page that needs no network."""

from __future__ import annotations

from pathlib import Path

from train.benchmark.showing.episode import shown_episode
from train.benchmark.showing.heat_map import RULE, heat_map
from train.benchmark.showing.legend import legend
from train.benchmark.showing.report import COLUMNS, HEADINGS, about, sections
from train.benchmark.showing.section import Section
from train.benchmark.table import BenchmarkTable, Row
from train.benchmark.targets import findings
from train.controllers.shipped import shipped_agents
from train.page import Cell, LearningCurves, PageContent, Table, write_page
from train.shared.curve import read_curve


def write_report(path: Path, table: BenchmarkTable) -> None:
    """Findings, heat map, every row, the blade where an agent gains most, learning curves, what went wrong, the configuration."""
    episode, note = shown_episode(table)
    wrong = [f"{where}: {sentence}" for where, sentence in table.sentences.items()]
    content = PageContent(
        title=f"Controllers of a {'rotating blade' if episode is None or episode.has_shape else 'model'} across scenarios",
        note="\n".join([*(each.sentence for each in findings(table)), *table.left_out, *wrong]),
        table=page_table(table),
        further={each.heading: further_table(each) for each in sections(table)},
        heat_map=heat_map(table),
        episode=episode,
        episode_note=note,
        learning=learning_curves(table),
        configuration=table.configuration,
    )
    write_page(path, content)


def learning_curves(table: BenchmarkTable) -> LearningCurves | None:
    """How the agents that ship for the nominal blade learned, the first run of each, beside LQG on it; None without any."""
    level = next((row for row in table.rows if (row.scenario, row.controller) == ("nominal", "lqg") and row.measured), None)
    own = {row.controller for row in table.rows if row.scenario == "nominal" and row.kind == "learned"}
    runs = {name: each.only_in["nominal"] for name, each in shipped_agents().items() if name in own and "nominal" in each.only_in}
    curves = {name: read_curve(next(iter(each.values())).folder) for name, each in runs.items()}
    if level is None or not curves:
        return None
    return LearningCurves(curves, {level.controller: level.estimates["relative_cost"].value})


def page_table(table: BenchmarkTable) -> Table:
    """All rows, to be sorted by a click."""
    headings = ("scenario", *HEADINGS, *(column.heading for column in COLUMNS))
    return Table(headings, tuple(_cells(row) for row in table.rows), f"{legend(table)}\n\n{RULE}")


def further_table(section: Section) -> Table:
    """A section, to be sorted by a click too."""
    return Table(tuple(section.headings), tuple(tuple(Cell(*each) for each in row) for row in section.rows), section.text)


def _cells(row: Row) -> tuple[Cell, ...]:
    first = [Cell(str(each), each if isinstance(each, int) else None) for each in (row.scenario, *about(row))]
    found = [(column, row.estimates.get(column.name)) for column in COLUMNS]
    return (*first, *(Cell(column.text(each), None if each is None else each.value) for column, each in found))
