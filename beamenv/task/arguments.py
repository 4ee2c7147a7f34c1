"""What steps and environments are given, checked."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.configuration.arrays import real_numbers
from beamenv.task.task import DType, Task

Array = NDArray[np.float64]


def checked_dtype(dtype: Any) -> DType:
    """One of the two, also from NumPy's types of these names; ``ValueError`` for any other."""
    try:
        name = np.dtype(dtype).name if dtype is not None else ""
    except (TypeError, ValueError):
        name = ""
    if name == "float32":
        return "float32"
    if name == "float64":
        return "float64"
    raise Refused("dtype", dtype, "'float32' or 'float64'")


_FLOATS = {"float64": np.dtype(np.float64), "float32": np.dtype(np.float32)}


def checked_task(task: Any) -> Task:
    """The task; ``ValueError`` for anything else."""
    if isinstance(task, Task):
        return task
    raise Refused("task", task, "a Task, such as resolve_task makes")


def checked_action(action: Any, shape: tuple[int, ...], precision: DType = "float64") -> NDArray[Any]:
    """The action in this precision; ValueError unless it has the shape and all its numbers are finite."""
    wanted = _FLOATS[precision]
    if type(action) is not np.ndarray or action.dtype not in _FLOATS.values():  # a blade alone has no time to look closer
        action = real_numbers("action", action)
    if action.dtype is not wanted:
        action = action.astype(wanted)
    if action.shape != shape:
        raise ValueError(f"action has shape {action.shape}, but must have shape {shape}.")
    finite = np.isfinite(action)
    if b"\0" in finite.tobytes():  # a blade alone has no time for ``all``
        wrong = np.argwhere(~finite)[0].tolist()
        raise ValueError(f"action{wrong} is {action[tuple(wrong)]}, but every number must be finite.")
    return action
