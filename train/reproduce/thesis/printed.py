"""The thesis' printed tables, as data."""

from __future__ import annotations

import csv
from importlib.resources import files

PRINTED = (
    *(f"table-2.{number}" for number in (1, 2)),
    *(f"table-3.{number}" for number in (1, 2, 3, 4)),
    *(f"table-6.{number}" for number in (1, 2, 3, 4)),
)

LAYOUTS = ("table-6.3", "table-6.4")
"""Those that the environment offers as layouts, and that therefore lie with it."""


def printed_table(name: str) -> list[dict[str, str]]:
    """The rows of a printed table, each a mapping of column names to what is printed; ``ValueError`` for an unknown name.

    Frequencies are in rad/s, in Table 3.2 in Hz; positions in m; the traces of chapter 6 have no unit printed.
    An empty cell is one on which the thesis contradicts itself.
    """
    if name not in PRINTED:
        raise ValueError(f"name = {name!r} must be one of {', '.join(PRINTED)}.")
    home = "beamenv.blade" if name in LAYOUTS else "beamenv.train.reproduce.thesis"
    text = files(home).joinpath("numbers", f"{name}.csv").read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))


def numbers(name: str, column: str) -> tuple[float, ...]:
    """One column of a printed table as numbers."""
    return tuple(float(row[column]) for row in printed_table(name))
