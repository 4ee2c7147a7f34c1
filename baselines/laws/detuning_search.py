"""What a detuned LQG's design is told, by a coordinate search; and what was found, as it ships or lies in the user's cache."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from baselines.design.delay import MOST_LATE
from baselines.laws.detuned_lqg import Detuning
from beamenv.configuration import read
from beamenv.configuration.cache import keep, kept_at, key_of

TRIALS = 40
"""Designs that are tried at most."""

GAIN = 1e-3
"""Share of the cost by which a design must be better than the best so far."""

LOST = 100.0
"""What a blade that fails, or a plant whose loop is unstable, is charged over the mean cost without control."""


def kept_detuning(name: str, shipped: Path, depends_on: tuple[Any, ...], search: Callable[[], Detuning]) -> Detuning:
    """As it ships in a table, was kept in the user's cache, or is searched for now, for the key of what it depends on."""
    if (found := shipped_detunings(shipped).get(key_of(*depends_on))) is not None:
        return found
    kept = kept_at(name, *depends_on)
    try:
        return read(Detuning(), json.loads(kept.read_text(encoding="utf-8")), "detuning")
    except (OSError, ValueError):
        found = search()
    keep(kept, asdict(found))
    return found


def coordinate_search(
    cost: Callable[[Detuning], float], start: Detuning, loads: bool, trials: int = TRIALS
) -> tuple[Detuning, dict[Detuning, float]]:
    """From a start on, in one coordinate after the other as far as that is better, again and again until nothing is; all trials."""
    tried = {start: cost(start)}
    best, moved = start, True
    while moved and len(tried) < trials:
        moved = False
        for direction in _directions(loads):
            while len(tried) < trials:
                further = direction(best)
                if further in tried:
                    break
                tried[further] = cost(further)
                if not tried[further] < (1.0 - GAIN) * tried[best]:
                    break
                best, moved = further, True
    return best, tried


def _directions(loads: bool) -> Iterator[Callable[[Detuning], Detuning]]:
    """Steps in each coordinate, the most telling first."""
    if loads:
        yield lambda each: replace(each, foresees=not each.foresees)
    yield lambda each: replace(each, rate=3.0 * each.rate)
    yield lambda each: replace(each, rate=each.rate / 3.0)
    yield lambda each: replace(each, noise=2.0 * each.noise)
    yield lambda each: replace(each, noise=0.5 * each.noise)
    yield lambda each: replace(each, effort=1.5 * each.effort)
    yield lambda each: replace(each, effort=each.effort / 1.5)
    yield lambda each: replace(each, delay=min(MOST_LATE, each.delay + 1))
    yield lambda each: replace(each, delay=max(0, each.delay - 1))


@lru_cache
def shipped_detunings(path: Path) -> dict[str, Detuning]:
    """Those of a table, by their keys."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {row["key"]: _detuning(row) for row in rows}


def _detuning(row: dict[str, str]) -> Detuning:
    numbers = {name: float(row[name]) for name in ("effort", "noise", "rate")}
    return Detuning(delay=int(row["delay"]), foresees=row["foresees"] == "True", **numbers)
