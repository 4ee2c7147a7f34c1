"""Scenarios composed at random, for training alone: faults of several kinds at once, milder and wider than those with a name.

What is kept for judging stays unseen: the kinds of fault of a scenario of ``UNSEEN`` never come together alone, and voltages are no
more than three intervals late.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from itertools import combinations
from typing import Any

import numpy as np

from beamenv.task import Task, resolve_task
from train.learning.through_plant.modal_errors import MistakenTask

KINDS = ("delay", "failure", "hysteresis", "off-model", "off-speed", "rotor")

KEPT = frozenset(map(frozenset, (("delay", "failure"), ("delay", "off-model"), ("hysteresis", "rotor"), ("failure", "off-speed"))))
"""Kinds that come together in scenarios kept for judging."""

SETS = tuple(chosen for size in (2, 3, 4) for chosen in combinations(KINDS, size) if frozenset(chosen) not in KEPT)
"""Kinds of fault that may come together in training."""

WIDTH = (0.4, 1.2)
"""Range of what a fault's own range is multiplied by."""

PLANTS = 16
"""In the bank of each."""

ALONE = 6
"""Of so many compositions one is of plants that are wrong in their modes, and of nothing else."""


def compositions(task: Task, count: int, seed: int) -> list[Task]:
    """``count`` tasks like the given one but for their scenarios.

    Of every two one has plants with errors in the upper modes, and of every six one has those and their damping's alone.
    """
    generator = np.random.default_rng(seed)
    composed = enumerate(contents(count, generator))
    return [_composed(task, _WRONG_MODES if k % ALONE == 0 else content, k) for k, content in composed]


_WRONG_MODES: dict[str, Any] = {"plants": {"bank": PLANTS, "damping_ratio": [0.003, 0.02]}}


def contents(count: int, generator: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Tables of scenarios, as a scenario's file has them; no two of the first ``len(SETS)`` have the same kinds of fault."""
    while count > 0:
        for place in generator.permutation(len(SETS))[:count]:
            content: dict[str, Any] = {"plants": {"bank": PLANTS, "seed": 1000 + count}}
            for kind in SETS[place]:
                _add(content, _FAULTS[kind](_width(generator), generator))
            count -= 1
            yield content


def _width(generator: np.random.Generator) -> float:
    return round(float(generator.uniform(*WIDTH)), 3)


def _about_one(share: float) -> list[float]:
    return [round(1.0 - share, 4), round(1.0 + share, 4)]


def _delay(width: float, generator: np.random.Generator) -> dict[str, Any]:
    latest = int(generator.integers(1, 4))
    return {"drive": {"delay": [int(generator.integers(0, latest + 1)), latest]}, "acquisition": {"dropout": 0.05 * width}}


def _failure(width: float, generator: np.random.Generator) -> dict[str, Any]:
    remaining = float(generator.choice([0.0, 0.8]))
    return {"failures": {"dead_actuators": 1, "remaining": [0.0, remaining], "faulty_sensors": 1, "bias": [0.0, 0.2 * width]}}


def _hysteresis(width: float, generator: np.random.Generator) -> dict[str, Any]:
    return {"drive": {"hysteresis": 0.2 * width, "voltage_limits": [-500.0, 1500.0]}}


def _off_model(width: float, generator: np.random.Generator) -> dict[str, Any]:
    ratios = dict.fromkeys(("ply_angle_ratio", "modulus_ratio", "mass_ratio"), _about_one(0.1 * width))
    return {"plants": {**ratios, "damping_ratio": [0.003, 0.02]}}


def _off_speed(width: float, generator: np.random.Generator) -> dict[str, Any]:
    return {"plants": {"speed_ratio": _about_one(0.3 * width)}}


def _rotor(width: float, generator: np.random.Generator) -> dict[str, Any]:
    return {"rotor": {"harmonics": [round(each * width, 3) for each in (6.0, 4.0, 2.0, 1.0)], "turbulence": 5.0 * width}}


_FAULTS = {
    "delay": _delay,
    "failure": _failure,
    "hysteresis": _hysteresis,
    "off-model": _off_model,
    "off-speed": _off_speed,
    "rotor": _rotor,
}


def _add(content: dict[str, Any], more: Mapping[str, Mapping[str, Any]]) -> None:
    for table, own in more.items():
        content[table] = {**content.get(table, {}), **own}


def _composed(task: Task, content: dict[str, Any], place: int) -> Task:
    blade, duration = task.config, task.steps * task.config.control_interval
    whole = resolve_task(blade=blade, scenario=content, duration=duration, physical_units=task.physical_units)
    if place % 2:
        return whole
    return MistakenTask(**{each.name: getattr(whole, each.name) for each in fields(whole)}, errors=place)
