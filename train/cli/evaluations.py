"""Evaluations as a terminal shows them."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table
from rich.text import Text

from baselines import Evaluation


def screen_table(evaluations: Sequence[Evaluation]) -> Table:
    """One row a controller, best first."""
    from train.comparison.table import HEADINGS, caption, cells, ranked

    table = Table(title="Controllers compared", caption=caption(evaluations))
    for heading in HEADINGS:
        table.add_column(heading, justify="left" if heading == HEADINGS[0] else "right")
    for evaluation in ranked(evaluations):
        table.add_row(*map(Text, cells(evaluation)))
    return table
