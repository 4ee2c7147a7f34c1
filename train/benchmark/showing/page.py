"""The benchmark as one page that needs no network."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from baselines import Estimate
from beamenv.knowledge import TRUTH
from train.benchmark.listed import ListedController
from train.benchmark.showing.episode import ShownEpisode, shown_episode
from train.benchmark.showing.findings import findings_table
from train.benchmark.showing.heat_map import RULE, heat_map
from train.benchmark.showing.legend import legend
from train.benchmark.showing.report import COLUMNS, HEADINGS, about, sections
from train.benchmark.showing.section import Section
from train.benchmark.table import RIVAL, BenchmarkTable, Row
from train.controllers.shipped import shipped_agents
from train.page import Cell, Lead, LearningCurves, PageContent, Table, write_page
from train.page.lead import COST, blade_in_words, counted, load_in_words
from train.page.recording import RecordingProgress
from train.shared.curve import drawn_as, read_curve

COLUMN = next(column for column in COLUMNS if column.name == "relative_cost")


def write_report(
    path: Path,
    table: BenchmarkTable,
    listed: Sequence[ListedController],
    progress: RecordingProgress | None = None,
) -> None:
    """Findings, heat map, every row, the blade where an agent gains most, learning curves, what went wrong, the configuration.

    Readers choose among those that are ``listed`` and measured in the episode's scenario; ``progress`` as in ``record_episode``.
    """
    shown = shown_episode(table, listed, progress)
    wrong = [f"{where}: {sentence}" for where, sentence in table.sentences.items()]
    content = PageContent(
        title=f"Controllers of a {'model' if of_model(table) else 'rotating blade'} across scenarios",
        lead=None if shown is None else lead(table, shown),
        note="\n".join([*table.left_out, *wrong]),
        table=page_table(table),
        further={each.heading: further_table(each) for each in (findings_table(table), *sections(table))},
        heat_map=heat_map(table),
        episode=None if shown is None else shown.episode,
        episode_note="" if shown is None else shown.note,
        learning=learning_curves(table),
        configuration=table.configuration,
    )
    write_page(path, content)


def of_model(table: BenchmarkTable) -> bool:
    """Whether a model of one's own moves, and no blade."""
    return table.configuration.get("environment", {}).get("plant") is not None


def lead(table: BenchmarkTable, shown: ShownEpisode) -> Lead:
    """The least J in the first scenario and in the one that is shown, what moves under which loads, and how this was made."""
    first, last = table.configuration["seeds"]
    names = dict.fromkeys(["nominal" if "nominal" in table.scenarios else table.scenarios[0], shown.scenario])
    first_best, *further = [each for name in names if (each := least_rival(table, name)) is not None]
    others = [f"; in {row.scenario} it is {row.controller}: {_of_without(table, row)}" for row in further]
    moved, load = blade_in_words(shown.episode.blade), load_in_words(shown.episode.task.scenario)
    return Lead(
        f"In {first_best.scenario}, {first_best.controller} has the least {COST} of all controllers that see no more than a real "
        f"blade shows: {_of_without(table, first_best)}{''.join(others)}.",
        f"What moves is {moved}, in {shown.scenario} under {load}; {counted(len(table.controllers), 'controller')} went through "
        f"{counted(len(table.scenarios), 'scenario')} of {last - first + 1} held-out episodes each.",
    )


def least_rival(table: BenchmarkTable, scenario: str) -> Row | None:
    """Who has the least J there of all that see no more than a real blade shows; None if nobody was measured."""
    rows = [row for row in table.within(scenario) if row.measured and row.tier < TRUTH]
    return min(rows, key=lambda row: row.mean_cost, default=None)


def _of_without(table: BenchmarkTable, row: Row) -> str:
    rival = table.row(row.scenario, RIVAL)
    beside = "" if rival is None or not rival.measured or rival is row else f", where LQG has {COLUMN.text(_relative(rival))}"
    return f"{COLUMN.text(_relative(row))} of what it is without control{beside}"


def _relative(row: Row) -> Estimate:
    return row.estimates["relative_cost"]


def learning_curves(table: BenchmarkTable) -> LearningCurves | None:
    """How the agents that ship for the nominal blade learned, the first run of each, beside LQG on it; None without any."""
    level = next((row for row in table.rows if (row.scenario, row.controller) == ("nominal", "lqg") and row.measured), None)
    own = {row.controller for row in table.rows if row.scenario == "nominal" and row.kind == "learned"}
    runs = {name: each.only_in["nominal"] for name, each in shipped_agents().items() if name in own and "nominal" in each.only_in}
    firsts = {name: next(iter(each.values())).folder for name, each in runs.items()}
    curves = {drawn_as(name, folder): read_curve(folder) for name, folder in firsts.items()}
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
