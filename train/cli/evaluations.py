"""Evaluations as a terminal shows them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich.table import Table
from rich.text import Text

from baselines import Evaluation
from train.benchmark.runs import Runs
from train.comparison.table import Tiers, caption, cells, headings, ranked


def screen_table(evaluations: Sequence[Evaluation], tiers: Tiers = None) -> Table:
    """One row a controller, best first."""
    rows = (cells(evaluation, tiers) for evaluation in ranked(evaluations))
    return _table("Controllers compared", headings(tiers), rows, caption(evaluations, tiers))


def runs_table(runs: Runs) -> Table:
    """The runs of a training together, then one by one, with their spread below."""
    each = ([f"run {run}", *cells(evaluation)[1:]] for run, evaluation in runs.evaluations.items())
    return _table(runs.name, headings(), [runs.cells(), *each], f"{runs.sentence}. {caption([runs.first])}")


def _table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]], note: str) -> Table:
    table = Table(title=Text(title), caption=Text(note))
    for heading in columns:
        table.add_column(heading, justify="left" if heading == columns[0] else "right")
    for row in rows:
        table.add_row(*map(Text, row))
    return table
