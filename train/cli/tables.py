"""Tables as a terminal shows them: whole at 80 columns, with more to each row from 120 on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from rich.align import Align
from rich.box import SIMPLE_HEAD
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from train.cli.options import say

WIDE = 120
"""Columns of a terminal from which on all is shown that fits."""

GAP = 2
"""Between two columns of a table."""


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a table."""

    heading: str
    """On as many lines as it has."""
    words: bool = False
    """Whether it holds words, on the left; numbers are on the right."""
    wide: bool = False
    """Whether only wide terminals show it."""


def show_table(columns: Sequence[Column], rows: Sequence[Sequence[str]], title: str = "") -> None:
    """To standard output, with what a narrow terminal leaves out in a sentence below.

    Cells are never cut: what does not fit beside each other follows below, beside the first column again.
    """
    screen = Console()
    sizes = [max(map(_size, (each.heading, *(row[k] for row in rows)))) for k, each in enumerate(columns)]
    kept = shown(columns, sizes, screen.width)
    if title:
        say(title)
    for block in blocks([sizes[k] for k in kept], screen.width):
        chosen = [kept[k] for k in block]
        table = _table([columns[k] for k in chosen], [[row[k] for k in chosen] for row in rows])
        Console(width=max(screen.width, sum(sizes[k] + GAP for k in chosen))).print(table)
        say("")
    if left_out := [each.heading.replace("\n", " ") for k, each in enumerate(columns) if k not in kept]:
        say(f"A wider terminal shows besides: {'; '.join(left_out)}.")


def shown(columns: Sequence[Column], sizes: Sequence[int], width: int) -> list[int]:
    """Which columns a terminal of that width shows: all that are not for wide ones, and of these as many as fit."""
    kept = [k for k, each in enumerate(columns) if not each.wide]
    for k, each in enumerate(columns):
        if each.wide and (width < WIDE or sum(sizes[own] + GAP for own in (*kept, k)) - GAP > width):
            break
        if each.wide:
            kept.append(k)
    return sorted(kept)


def blocks(sizes: Sequence[int], width: int) -> Iterator[list[int]]:
    """Columns of these sizes in groups that fit, each begun by the first column, with one more at least."""
    first, *others = range(len(sizes))
    block = [first]
    for k in others:
        if len(block) > 1 and sum(sizes[each] + GAP for each in (*block, k)) - GAP > width:
            yield block
            block = [first]
        block.append(k)
    yield block


def _size(cell: str) -> int:
    return max(map(cell_len, cell.split("\n")))


def _table(columns: Sequence[Column], rows: Sequence[Sequence[str]]) -> Table:
    look = {"box": SIMPLE_HEAD, "show_edge": False, "padding": (0, GAP - 1, 0, 0), "pad_edge": False}
    made = Table(**look)  # type: ignore[arg-type]
    for column in columns:
        side: Literal["left", "right"] = "left" if column.words else "right"
        made.add_column(Align(Text(column.heading, justify=side), side, vertical="bottom"), justify=side, no_wrap=True)
    for row in rows:
        made.add_row(*map(Text, row))
    return made
