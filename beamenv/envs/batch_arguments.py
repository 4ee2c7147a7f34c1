"""Arguments that the batched environment alone takes, checked; ``ValueError`` names the one that is wrong."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from beamenv.configuration import Refused, Table, checked
from beamenv.scenarios.scenario import Scenario
from beamenv.task import Task, reset_options

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

MOST_DRAWN = 64
"""Blades that are drawn without being asked for one by one: each takes 20 MB and 40 ms a picture."""


def drawn_rows(name: str, value: Any, count: int) -> tuple[int, ...]:
    """Rows of the batch, from one number or a sequence; all of them if None."""
    if value is None and count <= MOST_DRAWN:
        return tuple(range(count))
    if value is None:
        raise Refused(name, None, f"given where more than {MOST_DRAWN} blades are to be drawn: rows of the {count}")
    allowed = f"None, an integer from 0 to {count - 1}, or a sequence of such integers"
    try:
        rows = np.atleast_1d(np.asarray(value))
    except (TypeError, ValueError, RuntimeError):
        raise Refused(name, value, allowed) from None
    if rows.ndim != 1 or rows.dtype.kind not in "iu" or not len(rows) or not np.all((rows >= 0) & (rows < count)):
        raise Refused(name, value, allowed)
    return tuple(rows.tolist())


@dataclass(frozen=True, slots=True)
class BatchReset:
    """What the options of a reset ask of a batch."""

    rows: Rows | None
    """Blades whose episode begins; None for all."""
    elapsed: Rows
    """(N,) control intervals already over."""
    scenario: Scenario
    initial_state: Array | None
    """(n,) or (rows, n)."""


def batch_reset(task: Task, options: Any, steps: int, count: int) -> BatchReset:
    """The options of a reset of ``count`` blades whose episodes have ``steps`` intervals."""
    rest: dict[str, Any] = {} if options is None else dict(checked("options", options, Table()))
    elapsed = _elapsed_intervals(rest.pop("elapsed", 0), steps, count)
    rows = _masked_rows(rest.pop("reset_mask", None), count)
    scenario, initial_state = reset_options(task, rest, count)
    if initial_state is not None and initial_state.ndim == 2 and rows is not None:
        initial_state = initial_state[rows]
    return BatchReset(rows, elapsed, scenario, initial_state)


def _elapsed_intervals(value: Any, steps: int, count: int) -> Rows:
    """Control intervals already over, one for each blade."""
    try:
        elapsed = np.asarray(value)
    except (TypeError, ValueError, RuntimeError):
        elapsed = np.zeros(0)
    if elapsed.shape not in ((), (count,)) or elapsed.dtype.kind not in "iu" or not np.all((elapsed >= 0) & (elapsed < steps)):
        raise Refused("options['elapsed']", value, f"integers from 0 to {steps - 1}, one or {count} of them")
    return np.array(np.broadcast_to(elapsed, (count,)), dtype=np.int64)


def _masked_rows(mask: Any, count: int) -> Rows | None:
    """Rows of a mask as Gymnasium's own batches take it; None without one."""
    if mask is None:
        return None
    if not (isinstance(mask, np.ndarray) and mask.shape == (count,) and mask.dtype == np.bool_ and mask.any()):
        raise Refused("options['reset_mask']", mask, f"an array of {count} bools, one of them True")
    return np.flatnonzero(mask)


def chosen_mode(value: Any) -> AutoresetMode:
    """One of Gymnasium's modes, or its name."""
    for mode in AutoresetMode:
        if isinstance(value, (str, AutoresetMode)) and value in (mode, mode.value):
            return mode
    raise Refused("autoreset_mode", value, f"one of {', '.join(repr(mode.value) for mode in AutoresetMode)}")
