"""Measured series of a load: numbers, or a CSV file of them; and functions of time."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic_core import CoreSchema, core_schema

from beamenv.configuration import Number, Numbers, Refused, clause
from beamenv.configuration.kinds import JsonSchema, Kind, plain
from beamenv.sensors.kinds import LARGEST

ENDING = ".csv"
LEAST = 2
"""Values of a series."""


@dataclass(frozen=True, slots=True)
class Series(Kind):
    """A sequence of numbers, or the name of a CSV file."""

    @property
    def allowed(self) -> str:
        """Either."""
        return f"{self._numbers.allowed}, or a {ENDING} file of them"

    @property
    def _numbers(self) -> Numbers:
        return Numbers(Number(ge=-LARGEST, le=LARGEST), least=LEAST)

    def core(self) -> CoreSchema:
        """A tuple of floats, or a string."""
        file = core_schema.str_schema(strict=True, pattern=r"(?i)\.csv$")
        return core_schema.no_info_before_validator_function(_given, core_schema.union_schema([file, self._numbers.inner()]))

    def json(self) -> JsonSchema:
        """A string or an array."""
        return {"anyOf": [{"type": "string", "pattern": "\\.[cC][sS][vV]$"}, self._numbers.json()]}


def _given(value: Any) -> Any:
    return os.fspath(value) if isinstance(value, os.PathLike) else plain(value)


@dataclass(frozen=True, slots=True)
class Function(Kind):
    """A function of Python's; in a file there is none."""

    @property
    def allowed(self) -> str:
        """A callable."""
        return "a function of the time in s, which no file can hold"

    def core(self) -> CoreSchema:
        """Anything that can be called."""
        return core_schema.callable_schema()

    def json(self) -> JsonSchema:
        """Nothing that JSON has."""
        return {"not": {}}


def read_series(path: str, name: str) -> tuple[float, ...]:
    """The values of a CSV file, one a line, after a line of words or not; ``ValueError`` that names a line without a number."""
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) and error.strerror else clause(error)
        raise Refused(name, path, f"a {ENDING} file with a number in each line, and cannot be read: {why}") from None
    while lines and not lines[-1].strip():
        lines.pop()
    first = 1 if lines and _number(lines[0]) is None and any(mark.isalpha() for mark in lines[0]) else 0
    values = [_number(line) for line in lines[first:]]
    for k, value in enumerate(values):
        if value is None:
            raise Refused(
                name, lines[first + k], f"a number of at most {LARGEST:g} in each line; line {first + k + 1} of {path!r} has none"
            )
    if len(values) < LEAST:
        raise Refused(name, path, f"a file of at least {LEAST} numbers")
    return tuple(value for value in values if value is not None)


def _number(line: str) -> float | None:
    try:
        value = float(line.strip().rstrip(","))
    except ValueError:
        return None
    return value if abs(value) <= LARGEST else None


def interval_means(values: tuple[float, ...], rate: float, interval: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """(K,): the mean over each control interval of straight lines through values sampled at ``rate`` (Hz), until the last value.

    So a load that is held over each interval hands over the impulse that was measured, whichever rate is the faster.
    """
    samples = np.asarray(values)
    times, end = np.arange(len(samples)) / rate, (len(samples) - 1) / rate
    count = max(int(math.ceil(end / interval - 1e-9)), 1)
    edges = np.minimum(np.arange(count + 1) * interval, end)
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * (samples[1:] + samples[:-1])) / rate])
    left = np.minimum(np.searchsorted(times, edges, side="right") - 1, len(samples) - 2)
    past = edges - times[left]
    slope = (samples[left + 1] - samples[left]) * rate
    until = impulse[left] + past * samples[left] + 0.5 * slope * past**2
    return np.asarray(np.diff(until) / interval)
