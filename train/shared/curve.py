"""Learning curves: ``learning.csv``, which a training writes and figures, pages and comparisons read."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import shown
from train.shared.files import write_csv

Array = NDArray[np.float64]

NAME = "learning.csv"

COLUMNS = ("elapsed", "steps", "updates", "cost")
"""s, control intervals, updates of the policy, J relative to no control."""


def write_curve(folder: Path, points: Sequence[Sequence[float]]) -> None:
    """``learning.csv`` of a training, a row of ``COLUMNS`` for each point."""
    write_csv(folder / NAME, [dict(zip(COLUMNS, point, strict=True)) for point in points], COLUMNS)


def read_curve(folder: Path) -> Array:
    """(k, 3): seconds, steps and cost, which is NaN as long as no episode has ended.

    ``ValueError`` of one sentence names the file, the line and what is expected if it is not there, damaged or something else.
    """
    path = folder / NAME
    try:
        with path.open(encoding="utf-8", newline="") as file:
            lines = csv.reader(file, strict=True)
            rows = [(lines.line_num, row) for row in lines]
    except OSError as error:
        raise ValueError(f"file {str(path)!r} cannot be read: {error.strerror}.") from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise ValueError(f"file {str(path)!r} cannot be read as the CSV file of a learning curve: {error}.") from None
    if not rows or tuple(rows[0][1]) != COLUMNS:
        first = shown(",".join(rows[0][1]) if rows else "")
        raise ValueError(f"file {str(path)!r} has in line 1 {first}, but must have the columns {','.join(COLUMNS)}.")
    points = [_numbers(path, line, row) for line, row in rows[1:]]
    return np.array([(elapsed, steps, cost) for elapsed, steps, _, cost in points], dtype=np.float64).reshape(-1, 3)


def _numbers(path: Path, line: int, row: Sequence[str]) -> list[float]:
    """One of each column, the cost alone perhaps not finite."""
    try:
        numbers = [float(cell) for cell in row]
    except ValueError:
        numbers = []
    if len(numbers) != len(COLUMNS) or not np.isfinite(numbers[:-1]).all():
        raise ValueError(
            f"file {str(path)!r} has in line {line} {shown(','.join(row))}, but must have numbers of {','.join(COLUMNS)}."
        )
    return numbers
