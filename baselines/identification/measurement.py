"""What was measured: voltages and readings, row by row at one rate, and what makes them no measurement to identify from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Refused, Text, Texts, checked
from beamenv.configuration.arrays import check_finite, checked_array
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

FEWEST_ROWS = 100
"""Below this there is nothing to be learned."""

LARGEST = 1e100
"""Of any column: squares stay finite."""

CLIPPED = 0.05
"""Share of the rows in which a reading may be the very largest or smallest that there is: what moves freely is so twice."""

ALIKE = 1e-6
"""Smallest share of the voltages' variance, over its largest, in any direction: below it they have not moved on their own."""


@dataclass(frozen=True, slots=True, eq=False)
class Measurement(ReadOnly):
    """N rows of m voltages and p readings at one rate.

    The reading of row k is taken at t_k, and the voltage of row k is put on right after it and held until t_{k+1}, as the
    environment does: a reading shows no voltage of its own row.
    """

    voltages: Array
    """(N, m), V."""
    readings: Array
    """(N, p), each in its sensor's unit."""
    interval: float
    """s between rows."""
    voltage_names: tuple[str, ...] = ()
    reading_names: tuple[str, ...] = ()
    reading_units: tuple[str, ...] = ()
    """Such as A, V or m/s²; empty where nobody said."""

    def __post_init__(self) -> None:
        """``ValueError`` of one sentence for data that are not finite, too few, constant or cut off, or move together."""
        voltages = checked_array("voltages", self.voltages, (None, None), "a row for each instant, a column for each actuator")
        readings = checked_array("readings", self.readings, (len(voltages), None), "a row for each instant, a column each sensor")
        kept = {
            "voltages": voltages,
            "readings": readings,
            "interval": checked("interval", self.interval, Number(gt=0.0, unit="s")),
            "voltage_names": _names("voltage_names", self.voltage_names, "u", voltages.shape[1]),
            "reading_names": _names("reading_names", self.reading_names, "y", readings.shape[1]),
            "reading_units": _units(self.reading_units, readings.shape[1]),
        }
        for name, value in kept.items():
            object.__setattr__(self, name, value)
        if len(voltages) < FEWEST_ROWS:
            raise ValueError(f"the measurement has {len(voltages)} rows, but must have at least {FEWEST_ROWS}.")
        _check_moving(voltages, self.voltage_names)
        _check_moving(readings, self.reading_names)
        _check_free(readings, self.reading_names)
        _check_apart(voltages, self.voltage_names)
        ReadOnly.__post_init__(self)

    def __len__(self) -> int:
        return len(self.voltages)

    @property
    def seconds(self) -> float:
        """How long it lasts, s."""
        return len(self) * self.interval

    def first(self, rows: int) -> Measurement:
        """Its first rows alone."""
        return replace(self, voltages=self.voltages[:rows], readings=self.readings[:rows])


def _names(path: str, given: Sequence[str], letter: str, count: int) -> tuple[str, ...]:
    names = checked(path, given, Texts())
    if len(names) not in (0, count):
        raise Refused(path, given, f"{count} names, one for each column")
    return tuple(checked(path, each, Text(line=True)) for each in names) or tuple(f"{letter}{k}" for k in range(1, count + 1))


def _units(given: Sequence[str], count: int) -> tuple[str, ...]:
    units = checked("reading_units", given, Texts())
    if len(units) not in (0, count):
        raise Refused("reading_units", given, f"{count} units, one for each column")
    return units or ("",) * count


def _check_moving(columns: Array, names: Sequence[str]) -> None:
    check_finite("the measurement", columns)
    largest = np.abs(columns).max(axis=0)
    if (beyond := np.flatnonzero(largest > LARGEST)).size:
        raise ValueError(f"column {names[beyond[0]]!r} goes up to {largest[beyond[0]]:.3g}, but must stay within {LARGEST:g}.")
    spread = columns.std(axis=0)
    still = np.flatnonzero(~(spread > 1e-12 * largest))
    if len(still):
        raise ValueError(f"column {names[still[0]]!r} is constant, but must move for anything to be learned from it.")


def _check_free(readings: Array, names: Sequence[str]) -> None:
    """A reading that its sensor's range cuts off is no linear answer to anything."""
    low, high = readings.min(axis=0), readings.max(axis=0)
    near = 1e-9 * (high - low)
    at_limits = ((readings <= low + near) | (readings >= high - near)).mean(axis=0)
    for k in np.flatnonzero(at_limits > CLIPPED).tolist():
        raise ValueError(
            f"column {names[k]!r} is at its limits, {low[k]:.4g} and {high[k]:.4g}, in {100.0 * at_limits[k]:.0f} % of the rows, "
            f"but may be in {100.0 * CLIPPED:g} %: let voltages be smaller or each be held for longer, or give the sensor "
            "a wider range."
        )


def _check_apart(voltages: Array, names: Sequence[str]) -> None:
    """Two voltages that are always in proportion cannot be told apart."""
    shares = np.linalg.eigvalsh(np.atleast_2d(np.corrcoef(voltages.T)))
    if shares[0] < ALIKE * shares[-1]:
        raise ValueError(f"voltages {', '.join(names)} are in proportion to each other, but each must move on its own.")
