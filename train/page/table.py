"""A table that is sorted by a click on its headings."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Cell:
    """What is read, and the number it is ranked by; None where the text ranks itself."""

    text: str
    value: float | None = None


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of one length. Raises ``ValueError`` for a row that is longer or shorter than the headings."""

    headings: tuple[str, ...]
    """With units."""
    rows: tuple[tuple[Cell, ...], ...]
    caption: str = ""

    def __post_init__(self) -> None:
        wrong = [row for row in self.rows if len(row) != len(self.headings)]
        if wrong:
            raise ValueError(f"rows has one of {len(wrong[0])} cells, but each must have {len(self.headings)}, one a heading.")

    @property
    def text_columns(self) -> tuple[int, ...]:
        """Places of the columns that have no numbers."""
        return tuple(place for place in range(len(self.headings)) if all(row[place].value is None for row in self.rows))
