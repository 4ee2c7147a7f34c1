"""The comparison as a table, in CSV and Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from baselines import Evaluation
from beamenv.configuration.writing import write_whole
from train.shared import markdown
from train.shared.columns import EVALUATION
from train.shared.files import write_csv

HEADINGS = ("controller", *(column.heading for column in EVALUATION))


def ranked(evaluations: Sequence[Evaluation]) -> list[Evaluation]:
    """Best first."""
    return sorted(evaluations, key=lambda evaluation: evaluation.relative_cost.value)


def cells(evaluation: Evaluation) -> list[str]:
    """Name, then every column."""
    return [evaluation.name, *(column.text(getattr(evaluation, column.name)) for column in EVALUATION)]


def caption(evaluations: Sequence[Evaluation]) -> str:
    """What the table rests on."""
    first = evaluations[0]
    seeds = first.episodes.seeds
    return (
        f"{len(seeds)} held-out episodes (seeds {seeds[0]} to {seeds[-1]}), the same for every controller; "
        f"brackets: {100 * first.confidence:.0f} % bootstrap intervals over seeds. "
        "Controllers marked (true state) see what no sensor shows: bounds, not rivals."
    )


def markdown_table(evaluations: Sequence[Evaluation]) -> str:
    """The table in Markdown, best first, with its caption."""
    rows = [cells(evaluation) for evaluation in ranked(evaluations)]
    return f"{markdown.table(HEADINGS, rows, words=1)}\n\n{caption(evaluations)}\n"


def write_tables(folder: Path, evaluations: Sequence[Evaluation]) -> None:
    """``table.csv``, in SI units with every interval, and ``table.md``."""
    write_csv(folder / "table.csv", [evaluation.row() for evaluation in ranked(evaluations)])
    write_whole(folder / "table.md", markdown_table(evaluations))
