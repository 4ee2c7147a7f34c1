"""Evaluations as a terminal shows them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich.table import Table
from rich.text import Text

from baselines import Evaluation
from train.benchmark.runs import Runs
from train.comparison.table import HEADINGS, caption, cells, ranked


def screen_table(evaluations: Sequence[Evaluation]) -> Table:
    """One row a controller, best first."""
    return _table("Controllers compared", (cells(evaluation) for evaluation in ranked(evaluations)), caption(evaluations))


def runs_table(runs: Runs) -> Table:
    """The runs of a training together, then one by one, with their spread below."""
    each = ([f"run {run}", *cells(evaluation)[1:]] for run, evaluation in runs.evaluations.items())
    return _table(runs.name, [runs.cells(), *each], f"{runs.sentence}. {caption([runs.first])}")


def _table(title: str, rows: Iterable[Sequence[str]], note: str) -> Table:
    table = Table(title=Text(title), caption=Text(note))
    for heading in HEADINGS:
        table.add_column(heading, justify="left" if heading == HEADINGS[0] else "right")
    for row in rows:
        table.add_row(*map(Text, row))
    return table
