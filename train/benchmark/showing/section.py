"""A table under a heading, as the benchmark's Markdown and its page both show it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from baselines import Estimate
from train.shared.columns import Column
from train.shared.markdown import escaped
from train.shared.markdown import table as markdown_table

COST, GAP = (Column("", "", 1.0, form, interval=True) for form in ("{:.3f}", "{:+.3f}"))
"""How costs and scores are written, and how differences of such."""


class Entry(NamedTuple):
    """What is read, and the number it is ranked by; None where the text ranks itself."""

    text: str
    value: float | None = None


@dataclass(frozen=True, slots=True)
class Section:
    """Rows of one length, of text first and then of numbers."""

    heading: str
    text: str
    """What the numbers are; paragraphs are parted by an empty line."""
    headings: Sequence[str]
    rows: Sequence[Sequence[Entry]]
    words: int
    """Columns of text."""

    def markdown(self, level: int = 3) -> str:
        """Heading of a level, text and table; empty without rows."""
        if not self.rows:
            return ""
        table = markdown_table(self.headings, [[each.text for each in row] for row in self.rows], self.words)
        return f"{'#' * level} {escaped(self.heading)}\n\n{self.text}\n\n{table}"


def words(*texts: object) -> list[Entry]:
    """Of text."""
    return [Entry(str(each)) for each in texts]


def in_words(controller: str) -> str:
    """Of an id amid a sentence or a list of names: "none" alone would say that there is nobody."""
    return "no control" if controller == "none" else controller


def cost(estimate: Estimate | None) -> Entry:
    """Of a cost or a score, a dash for None."""
    return Entry(COST.text(estimate), None if estimate is None else estimate.value)


def gap(estimate: Estimate | None) -> Entry:
    """Of a difference, a dash for None."""
    return Entry(GAP.text(estimate), None if estimate is None else estimate.value)
