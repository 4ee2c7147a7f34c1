"""What the disturbances and the sensors of a plant are: names and units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamenv.configuration import Refused, Text, checked

REFERENCE_LOAD = 30.0
"""N/m of uniform line load: with it LQG saturates now and then, and damps what follows within half an episode."""


@dataclass(frozen=True, slots=True)
class Signal:
    """A scalar signal: what it is called, and in which unit it is counted."""

    name: str
    unit: str

    def __post_init__(self) -> None:
        checked("signal.name", self.name, Text(line=True))
        checked("signal.unit", self.unit, Text())


LINE_LOADS = (Signal("lag", "N/m"), Signal("flap", "N/m"))
"""The uniform line loads on a blade."""


def usual_disturbances(count: int) -> tuple[Signal, ...]:
    """Two are the line loads; any others are just numbered."""
    return LINE_LOADS if count == 2 else tuple(Signal(f"disturbance {k}", "") for k in range(count))


def currents(count: int) -> tuple[Signal, ...]:
    """Of as many piezoelectric sensors."""
    return tuple(Signal(f"current {k}", "A") for k in range(count))


def checked_signals(name: str, given: Any, count: int, usual: Callable[[int], tuple[Signal, ...]]) -> tuple[Signal, ...]:
    """So many signals, the ``usual`` ones where none were given or those of another number; ``ValueError`` for anything else."""
    if isinstance(given, np.ndarray):
        given = given.tolist()
    if isinstance(given, (list, tuple)):  # of a file that holds a plant's fields by their names
        given = [Signal(**each) if isinstance(each, dict) and set(each) == {"name", "unit"} else each for each in given]
    if isinstance(given, list) and all(isinstance(each, Signal) for each in given):
        if len(given) == count:
            return tuple(given)
        if tuple(given) in ((), usual(len(given))):  # of a plant that this one departs from
            return usual(count)
    raise Refused(name, given, f"a tuple of {count} Signal(name, unit)")


def usual_reference(disturbances: tuple[Signal, ...]) -> list[float]:
    """30 N/m of a line load, 1 of anything else."""
    return [REFERENCE_LOAD if each.unit == "N/m" else 1.0 for each in disturbances]
