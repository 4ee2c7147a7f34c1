"""Learning curves: ``learning.csv``, which a training writes and figures, pages and comparisons read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import shown
from train.shared.files import read_rows, write_csv

Array = NDArray[np.float64]

NAME, PICTURE = "learning.csv", "learning.png"

COLUMNS = ("elapsed", "steps", "updates", "cost")
"""s, control intervals, updates of the policy, J relative to no control in training, exploration included."""

VALIDATION = "validation"
"""A further column, where a training looked and kept the best: J over no control on validation seeds, without exploration."""

LOOKED = "looked"
"""The same where a training was looked at, and kept the last."""


def write_curve(folder: Path, points: Sequence[Sequence[float]], further: str = VALIDATION) -> None:
    """``learning.csv`` of a training, a row of ``COLUMNS`` and the ``further`` one for each point; NaN is where nobody looked."""
    looked = any(np.isfinite(point[len(COLUMNS)]) for point in points)
    columns = (*COLUMNS, further) if looked else COLUMNS
    write_csv(folder / NAME, [dict(zip(columns, point, strict=False)) for point in points], columns)


def read_curve(folder: Path) -> Array:
    """(k, 3): seconds, steps and cost, which is NaN as long as no episode has ended; only what validation saw, if it looked.

    ``ValueError`` of one sentence names the file, the line and what is expected if it is not there, damaged or something else.
    """
    path = folder / NAME
    rows = read_rows(path, "a learning curve")
    further = tuple(name for name in (VALIDATION, LOOKED) if rows and name in rows[0][1])[:1]
    columns = (*COLUMNS, *further)
    if not rows or tuple(rows[0][1]) != columns:
        first = shown(",".join(rows[0][1]) if rows else "")
        raise ValueError(f"file {str(path)!r} has in line 1 {first}, but must have the columns {','.join(COLUMNS)}.")
    points = np.array([_numbers(path, line, row, columns) for line, row in rows[1:]], dtype=np.float64).reshape(-1, len(columns))
    seen = points[np.isfinite(points[:, -1])] if further else points
    return np.ascontiguousarray(seen[:, [0, 1, -1]])


def drawn_as(name: str, folder: Path) -> str:
    """An agent's name beside its curve, which is of training episodes where nobody looked on validation seeds."""
    return name if _further(folder) else f"{name}, in training"


def kept_cost(folder: Path) -> float:
    """Cost of the policy that a training kept: the least that validation saw, or the last; infinite if the last is no number."""
    costs = read_curve(folder)[:, 2].tolist() if (folder / NAME).exists() else []
    best_is_kept = bool(costs) and _further(folder) == VALIDATION
    kept = min(costs) if best_is_kept else costs[-1] if costs else float("nan")
    return float(kept) if kept == kept else float("inf")


def validated(folder: Path) -> float:
    """J over no control of the policy that was kept, on validation seeds and without exploration; NaN where nobody looked."""
    return kept_cost(folder) if (folder / NAME).exists() and _further(folder) else float("nan")


def _further(folder: Path) -> str:
    """The column beside ``COLUMNS``; empty without one."""
    last = (folder / NAME).read_text(encoding="utf-8").partition("\n")[0].strip().rpartition(",")[2]
    return last if last in (VALIDATION, LOOKED) else ""


def _numbers(path: Path, line: int, row: Sequence[str], columns: Sequence[str]) -> list[float]:
    """One of each column, costs alone perhaps not finite."""
    try:
        numbers = [float(cell) for cell in row]
    except ValueError:
        numbers = []
    if len(numbers) != len(columns) or not np.isfinite(numbers[: len(COLUMNS) - 1]).all():
        raise ValueError(
            f"file {str(path)!r} has in line {line} {shown(','.join(row))}, but must have numbers of {','.join(columns)}."
        )
    return numbers
