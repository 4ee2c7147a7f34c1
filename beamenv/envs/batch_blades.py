"""What the batched environment is made of: blades of one or of several tasks, and info with Gymnasium's masks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import REFERENCE, Arrays
from beamenv.simulation.blades import Blades
from beamenv.simulation.mixed_blades import MixedBlades
from beamenv.task import INFO, Task

Mask = NDArray[np.bool_]


def blades_of(tasks: Sequence[Task], count: int, arrays: Arrays = REFERENCE) -> Blades | MixedBlades:
    """Blade k that of task k modulo their number; equal ones are one."""
    if len(tasks) == 1:
        return Blades(tasks[0].bank, tasks[0].scenario, count, tasks[0].physical_units, arrays)
    different: dict[Any, Task] = {}
    for task in tasks[:count]:
        different.setdefault((task.blade, task.design_blade), task)
    place = {blades: place for place, blades in enumerate(different)}
    kind = np.resize(np.array([place[task.blade, task.design_blade] for task in tasks[:count]]), count)
    return MixedBlades([task.bank for task in different.values()], kind, tasks[0].scenario, tasks[0].physical_units, arrays)


def masked(info: dict[str, Any], mask: Mask | None = None) -> dict[str, Any]:
    """Info with Gymnasium's mask "_key" beside every key: which rows it holds for, all if None."""
    mask = np.ones(len(info[INFO[0]]), dtype=np.bool_) if mask is None else mask
    for name in INFO:
        info[f"_{name}"] = mask.copy()
    return info


def of_rows(info: dict[str, Any], rows: NDArray[np.int64], count: int) -> dict[str, Any]:
    """Info of ``rows`` alone as that of the batch: zeros elsewhere, which the masks leave out."""
    mask, whole = np.zeros(count, dtype=np.bool_), {}
    mask[rows] = True
    for name, values in info.items():
        whole[name] = np.zeros((count, *values.shape[1:]), values.dtype)
        whole[name][rows] = values
    return masked(whole, mask)
