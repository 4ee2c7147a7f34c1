"""Measurements as files: CSV with a header, and what is wrong with one in a sentence."""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from baselines.identification.measurement import Measurement
from beamenv.configuration import Flag, Number, Refused, Texts, checked
from beamenv.configuration.files import checked_path, content_of, of_file
from beamenv.configuration.sentence import shown, unknown_name

Array = NDArray[np.float64]

ENDING = ".csv"
SEPARATORS = (",", ";", "\t")
TIMES = ("time", "t")
JITTER = 0.1
"""Of an interval: how far an instant may lie from where a constant rate puts it, as printed digits make it."""
_UNIT = re.compile(r"^(?P<name>.*?)\s*[\[(](?P<unit>[^\])]*)[\])]$")


def read_measurement(
    path: str | os.PathLike[str],
    *,
    voltages: Sequence[str] | None = None,
    readings: Sequence[str] | None = None,
    time: str | None = None,
    interval: float | None = None,
    before: bool = False,
) -> Measurement:
    """The measurement in a CSV file whose first line names its columns, each perhaps with its unit: ``y1 [A]``.

    ``voltages`` and ``readings`` are names of columns; by default those that begin with u and with y. The rate follows from the
    column ``time`` (s), by default ``time`` or ``t``; if there is none, give the ``interval`` (s). ``before`` says that the
    voltages of each row were applied before its readings were taken, as when both are sampled together. Raises ``ValueError`` for
    a file that cannot be read, columns that are not there, cells without a number, rows that are missing or unevenly spaced, a
    rate other than ``interval``, and what ``Measurement`` refuses; the sentence names the file and, if there is one, the line.
    """
    place = checked_path("data", path, (ENDING,))
    asked = {name: None if each is None else checked(name, each, Texts()) for name, each in _asked(voltages, readings).items()}
    interval = None if interval is None else checked("interval", interval, Number(gt=0.0, unit="s"))
    later = int(checked("before", before, Flag()))
    text = _decoded(content_of(place), str(place))
    with of_file(place):
        names, units, cells = _table(text)
        chosen = {key: _chosen(key, names, asked[key], letter) for key, letter in (("voltages", "u"), ("readings", "y"))}
        if both := set(chosen["voltages"]) & set(chosen["readings"]):
            raise ValueError(f"column {names[min(both)]!r} is both a voltage and a reading, but must be one of them.")
        clock = _clock(names, time)
        values = _numbers(cells, names, [*chosen["voltages"], *chosen["readings"], *clock])
        m, both_count = len(chosen["voltages"]), len(chosen["voltages"]) + len(chosen["readings"])
        return Measurement(
            voltages=values[later:, :m],
            readings=values[: len(values) - later, m:both_count],
            interval=_rate(values[:, both_count:], interval),
            voltage_names=tuple(names[k] for k in chosen["voltages"]),
            reading_names=tuple(names[k] for k in chosen["readings"]),
            reading_units=tuple(units[k] for k in chosen["readings"]),
        )


def _asked(voltages: Sequence[str] | None, readings: Sequence[str] | None) -> dict[str, Sequence[str] | None]:
    return {"voltages": voltages, "readings": readings}


def _decoded(content: bytes, name: str) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"file {shown(name)} cannot be read: {error}.") from None


def _table(text: str) -> tuple[list[str], list[str], list[list[str]]]:
    """Names of the columns, their units, and the cells row by row."""
    header = text.partition("\n")[0]
    separator = max(SEPARATORS, key=header.count)
    try:
        rows = [[cell.strip() for cell in row] for row in csv.reader(io.StringIO(text), delimiter=separator)]
    except csv.Error as error:
        raise ValueError(f"it is no CSV: {error}.") from None
    if not rows or not any(rows[0]):
        raise ValueError("it is empty, but must have a line of names, then a row for each instant.")
    while rows and not any(rows[-1]):
        rows.pop()
    found = [_UNIT.match(cell) for cell in rows[0]]
    names = [each["name"] if each else cell for each, cell in zip(found, rows[0], strict=True)]
    if all(_is_number(name) for name in names):
        raise ValueError("its first line has numbers, but must name the columns.")
    if len(set(names)) < len(names):
        raise ValueError(f"two of its columns have the same name, {shown(names)}.")
    return names, [each["unit"] if each else "" for each in found], rows[1:]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _chosen(key: str, names: list[str], asked: Sequence[str] | None, letter: str) -> list[int]:
    """Positions of the columns asked for, or of those whose names begin with a letter."""
    if asked is None:
        found = [k for k, name in enumerate(names) if name[:1].lower() == letter]
        if not found:
            raise ValueError(f"no column begins with {letter}: its columns are {', '.join(names)}; {key} must name them.")
        return found
    if not asked or len(set(asked)) < len(asked):
        raise Refused(key, list(asked), "names of columns, at least one, each once")
    for name in asked:
        if name not in names:
            raise unknown_name(key, name, names)
    return [names.index(name) for name in asked]


def _clock(names: list[str], time: str | None) -> list[int]:
    """Position of the column of time, in a list; an empty one where there is none."""
    if time is not None and time not in names:
        raise unknown_name("time", time, names)
    lower = [name.lower() for name in names]
    usual = next((lower.index(each) for each in TIMES if each in lower), None)
    found = names.index(time) if time is not None else usual
    return [] if found is None else [found]


def _numbers(cells: list[list[str]], names: list[str], columns: list[int]) -> Array:
    """The chosen columns (N, k); the sentence names line and column of the first cell that holds no finite number."""
    values = np.empty((len(cells), len(columns)))
    for line, row in enumerate(cells, start=2):
        if len(row) != len(names):
            raise ValueError(f"line {line} has {len(row)} cells, but must have {len(names)}, as many as there are names.")
        values[line - 2] = [_number(row[column], names[column], line) for column in columns]
    wrong = np.argwhere(~np.isfinite(values))
    if len(wrong):
        row, k = wrong[0]
        raise ValueError(f"column {names[columns[k]]!r} is {values[row, k]} on line {row + 2}, but must be finite in every row.")
    return values


def _number(cell: str, name: str, line: int) -> float:
    try:
        return float(cell)
    except ValueError:
        what = f"holds {shown(cell)}" if cell else "is empty"
        raise ValueError(f"column {name!r} {what} on line {line}, but must be a number in every row.") from None


def _rate(times: Array, interval: float | None) -> float:
    """The interval (s) of rows at instants (N, 1), or at none that are known (N, 0)."""
    if times.shape[1] == 0:
        if interval is None:
            raise ValueError("it has no column of time, so interval must be given (s).")
        return interval
    return _constant_rate(times[:, 0], interval) if len(times) > 2 else interval or 1.0


def _constant_rate(times: Array, interval: float | None) -> float:
    steps = np.diff(times)
    usual = float(np.median(steps))
    if usual <= 0.0 or (steps <= 0.0).any():
        raise ValueError(f"time does not rise on line {int(np.argmax(steps <= min(0.0, usual))) + 3}, but must in every row.")
    if (steps > 1.5 * usual).any():
        row = int(np.argmax(steps > 1.5 * usual))
        raise ValueError(f"{steps[row]:.6g} s pass before line {row + 3}, but {usual:.6g} s elsewhere: rows are missing there.")
    found = float((times[-1] - times[0]) / len(steps))
    away = np.abs(times - times[0] - found * np.arange(len(times)))
    if away.max() > JITTER * found:
        row = int(np.argmax(away))
        raise ValueError(f"time on line {row + 2} is {away[row]:.3g} s off a constant rate of one row in {found:.6g} s.")
    if interval is not None and abs(found - interval) > 1e-3 * interval:
        raise ValueError(f"its rows are {found:.6g} s apart, but interval is {interval:g} s.")
    return found if interval is None else interval
