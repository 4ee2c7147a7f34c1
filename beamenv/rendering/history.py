"""What a picture shows of an episode: its last instants."""

from __future__ import annotations

from collections import deque
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

WINDOW = 0.2
"""s of the episode that a picture shows."""


NOTHING = np.zeros(0)


class Instant(NamedTuple):
    """One blade at the end of one control interval."""

    state: Array
    """(n,) true state, in energy coordinates of its plant."""
    plant: int
    """Place of the plant in the bank."""
    speed: float
    """rad/s."""
    tip_displacement: Array
    """(q,), m: lag, flap."""
    volts: Array
    """(m,), V, held over the interval."""
    reading: Array
    """(p,) sensor outputs in full scales."""
    cost_increment: float
    """J s."""
    load: Array = NOTHING
    """(k,), N/m: the line loads in lag and flap of the interval to come."""
    actuator_gain: Array = NOTHING
    """(m,): 0 of a dead one; of none if all are sound."""
    sensor_gain: Array = NOTHING
    """(p,), likewise."""


def gains(truth: Array, actuators: int, sensors: int) -> tuple[Array, Array]:
    """(…, m) of actuators and (…, p) of sensors, of what ``Blades.truth`` tells."""
    return truth[..., 2 : 2 + actuators], truth[..., 2 + actuators : 2 + actuators + sensors]


class History:
    """The instants of the last ``window`` seconds, sampled every ``interval`` (s). Recording one takes a microsecond."""

    def __init__(self, interval: float, window: float = WINDOW) -> None:
        self._interval = interval
        self._instants: deque[Instant] = deque(maxlen=round(window / interval) + 1)
        self._costs: deque[float] = deque(maxlen=self._instants.maxlen)
        self._steps = 0

    def begin(self, first: Instant) -> None:
        """Start an episode."""
        self._instants.clear()
        self._costs.clear()
        self._instants.append(_copied(first))
        self._costs.append(0.0)
        self._steps = 0

    def record(self, instant: Instant) -> None:
        """Take down the next instant."""
        self._instants.append(_copied(instant))
        self._costs.append(self._costs[-1] + instant.cost_increment)
        self._steps += 1

    @property
    def last(self) -> Instant:
        """The latest instant."""
        return self._instants[-1]

    @property
    def time(self) -> float:
        """Time since the episode began, s."""
        return self._steps * self._interval

    @property
    def ages(self) -> Array:
        """(k,) s: how long ago each instant was, negative, oldest first; the last is 0."""
        return self._interval * np.arange(1 - len(self._instants), 1, dtype=np.float64)

    @property
    def tips(self) -> Array:
        """(k, q), m: lag, flap."""
        return np.array([instant.tip_displacement for instant in self._instants])

    @property
    def readings(self) -> Array:
        """(k, p), in full scales."""
        return np.array([instant.reading for instant in self._instants])

    @property
    def volts(self) -> Array:
        """(k, m), V."""
        return np.array([instant.volts for instant in self._instants])

    @property
    def costs(self) -> Array:
        """(k,), J s: the cost of the episode up to each instant."""
        return np.array(self._costs)


def _copied(instant: Instant) -> Instant:
    """An instant that stays as it is whatever becomes of the arrays it came in."""
    arrays: dict[str, Any] = {name: value.copy() for name, value in instant._asdict().items() if isinstance(value, np.ndarray)}
    return instant._replace(**arrays)
