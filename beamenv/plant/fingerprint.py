"""A plant's fingerprint: the same for plants that a controller cannot tell apart."""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Instance, checked
from beamenv.plant.plant import Plant
from beamenv.plant.signals import REFERENCE_LOAD

Array = NDArray[np.float64]


def fingerprint(plant: Plant) -> str:
    """SHA-256, in hexadecimal, of what a controller meets: how the plant answers, its cost, noises, limits and clock.

    The answers are the transfer matrices from voltages and loads to currents and tip displacements at s = each natural
    frequency, on the real axis, where none is close to a pole. They do not depend on the signs of mode shapes, and all numbers
    are rounded to a millionth of the largest in their matrix, so that machines whose last digits differ agree.
    """
    checked("plant", plant, Instance(Plant))
    digest = sha256()
    for matrix in _met(plant):
        largest = float(np.abs(matrix).max(initial=0.0))
        rounded = np.rint(matrix * (1e6 / largest if largest else 0.0)).astype("<i8")
        digest.update(f"{matrix.shape} {largest:.5e} ".encode() + rounded.tobytes())
    return digest.hexdigest()


def _met(plant: Plant) -> Iterator[Array]:
    yield plant.natural_frequencies
    identity, moved = np.eye(len(plant.A)), []
    for inputs in (plant.B, plant.disturbance_input):
        states = [np.linalg.solve(s * identity - plant.A, inputs) for s in plant.natural_frequencies]
        yield from (outputs @ state for state in states for outputs in (plant.C, plant.tip_displacement))
        moved += states
    yield from (plant.D, plant.input_weight, plant.process_noise, plant.sensor_noise)
    yield from (plant.voltage_limits, plant.sensor_full_scale, np.array([plant.control_interval]))
    reference = np.asarray(plant.reference_load)
    own = not plant.in_energy_coordinates
    if own or np.any(reference != REFERENCE_LOAD):
        yield reference
    if own:  # what it costs to be moved does not follow from how it answers
        yield from (state.T @ np.asarray(plant.cross_weight) for state in moved)
        yield from (state.T @ plant.state_weight @ state for state in moved)
