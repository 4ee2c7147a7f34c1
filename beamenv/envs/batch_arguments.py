"""Arguments that the batched environment alone takes, checked; ``ValueError`` names the one that is wrong."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

Rows = NDArray[np.int64]


def drawn_rows(name: str, value: Any, count: int) -> tuple[int, ...]:
    """Rows of the batch, from one number or a sequence."""
    rows = np.atleast_1d(np.asarray(value))
    if rows.ndim != 1 or rows.dtype.kind not in "iu" or not len(rows) or not np.all((rows >= 0) & (rows < count)):
        raise ValueError(f"{name} is {value!r}, but must be an integer from 0 to {count - 1}, or a sequence of such integers.")
    return tuple(rows.tolist())


def elapsed_intervals(value: Any, steps: int, count: int) -> Rows:
    """Control intervals already over, one for each blade."""
    elapsed = np.asarray(value)
    if elapsed.shape not in ((), (count,)) or elapsed.dtype.kind not in "iu" or not np.all((elapsed >= 0) & (elapsed < steps)):
        raise ValueError(f"options['elapsed'] is {value!r}, but must be integers from 0 to {steps - 1}, one or {count} of them.")
    return elapsed.astype(np.int64)


def own_seeds(seed: Sequence[int], count: int) -> list[int]:
    """One seed for each blade."""
    try:
        seeds = [operator.index(number) for number in seed]
    except TypeError:
        seeds = [-1]
    if len(seeds) != count or min(seeds) < 0:
        raise ValueError(f"seed is {seed!r}, but must be an integer, or a sequence of {count} integers that are not negative.")
    return seeds


def chosen_mode(value: AutoresetMode | str) -> AutoresetMode:
    """One of the two modes that there are here."""
    selectable = (AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP)
    for mode in selectable:
        if value in (mode, mode.value):
            return mode
    raise ValueError(f"autoreset_mode is {value!r}, but must be one of {', '.join(repr(mode.value) for mode in selectable)}.")
