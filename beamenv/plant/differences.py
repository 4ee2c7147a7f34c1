"""In what plants with different fingerprints differ, in words."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from beamenv.plant.plant import Plant

ALIKE = 1e-6
"""Of the largest number of its kind: what a fingerprint does not see."""


def differences(plant: Plant, other: Plant) -> str:
    """What ``plant`` has that another has not, for whoever controls it, with both values where one number tells it.

    Where no field tells, it is how they answer voltages and loads, say by their damping.
    """
    found = list(_of_counts(plant, other)) or [*_of_numbers(plant, other), *_of_matrices(plant, other)]
    return ", ".join(found) or "other answers to voltages and loads"


def _of_counts(plant: Plant, other: Plant) -> Iterator[str]:
    counts: dict[str, Callable[[Plant], int]] = {
        "voltage": lambda each: each.B.shape[1],
        "sensor": lambda each: len(each.C),
        "mode": lambda each: len(each.natural_frequencies),
    }
    for what, count in counts.items():
        if count(plant) != count(other):
            yield f"{count(plant)} {what}{'s' if count(plant) != 1 else ''} in place of {count(other)}"


def _of_numbers(plant: Plant, other: Plant) -> Iterator[str]:
    numbers: dict[str, Callable[[Plant], float]] = {
        "a control interval of {:g} s": lambda each: each.control_interval,
        "a first natural frequency of {:.5g} rad/s": lambda each: float(each.natural_frequencies[0]),
        "a drive up to {:g} V": lambda each: float(each.voltage_limits.max()),
        "and down to {:g} V": lambda each: float(each.voltage_limits.min()),
    }
    for words, number in numbers.items():
        own, its = number(plant), number(other)
        if not np.isclose(own, its, rtol=ALIKE, atol=0.0):
            yield f"{words.format(own)} in place of {its:.5g}"


def _of_matrices(plant: Plant, other: Plant) -> Iterator[str]:
    fields = {
        "sensor_full_scale": "another full scale of its sensors",
        "sensor_noise": "other noise of its sensors",
        "process_noise": "other noise of its loads",
        "input_weight": "another price of voltages",
    }
    for name, words in fields.items():
        own, its = (np.asarray(getattr(each, name)) for each in (plant, other))
        if own.shape != its.shape or np.abs(own - its).max(initial=0.0) > ALIKE * np.abs(its).max(initial=0.0):
            yield words
