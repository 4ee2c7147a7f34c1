"""The readings of a plant: its modes' share of what sensors feel, what feeds through to them, their ranges and noise.

With the modes Ψ, x = [ω η; η̇] and ẋ = A x + B u + E d, a reading R q + S q̇ + T q̈ is C x + D u + F d, where

    C = [RΨ/ω, SΨ] + [0, TΨ] A,        D = [0, TΨ] B + D₀,        F = [0, TΨ] E.

D₀ is what the modes that are left out add to the static state: they follow the voltages at once. What they add to S q̇ is its rate,
and passes the electronics as that of patch currents does. Of T q̈ they add nothing, for they do not move in modes of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from beamenv.configuration import Refused
from beamenv.configuration.read_only import sealed
from beamenv.plant.electronics import static_residual
from beamenv.plant.plant import Plant
from beamenv.plant.reduction import FULL_SCALE_MARGIN, MOST_SAMPLES, ModalModel, acting_on_velocities, on_velocities
from beamenv.sensors.kinds import PatchCurrent, Sensor
from beamenv.sensors.rows import SensorRows

Array = NDArray[np.float64]


def outputs(displaced: Array, rate: Array, accelerated: Array, dynamics: Array) -> Array:
    """C (p, 2r) of readings (p, r) of the first states and of the modal velocities, and (p, 2r) of the rates of all."""
    return np.asarray(np.hstack([displaced, rate]) + accelerated @ dynamics)


def load_feedthrough(rows: SensorRows, modal: ModalModel, line_load: Array) -> Array:
    """F (p, k): what accelerometers show of a load at once, by the modes of a plant."""
    shapes = modal.mode_shapes
    return np.asarray(on_velocities(rows.acceleration @ shapes) @ acting_on_velocities(shapes.T @ line_load))


def static_feedthrough(rows: SensorRows, modal: ModalModel, forces: Array) -> Array:
    """D₀ (p, m), of forces F (N, m) per V."""
    shapes = modal.mode_shapes
    return static_residual(rows.static_position, rows.position @ shapes, shapes.T @ forces, modal.natural_frequencies)


def rate_residual(rows: SensorRows, modal: ModalModel, forces: Array) -> Array:
    """(p, m): what the modes left out add to the static state of those readings whose rate is taken."""
    shapes = modal.mode_shapes
    return static_residual(rows.static_rate, rows.rate @ shapes, shapes.T @ forces, modal.natural_frequencies)


def with_readings(
    plant: Plant,
    rows: SensorRows,
    modal: ModalModel,
    *,
    sensors: Sequence[Sensor],
    forces: Array,
    line_load: Array,
    noise: float,
    current_range: float | None,
    full_scale: Array | None,
    filtered: bool,
) -> Plant:
    """The plant of a blade alone with the readings of sensors in place of its patches' currents.

    ``full_scale`` (p,) where it is known already, ``noise`` and ``current_range`` where sensors do not say. What loads feed through
    to the readings is left to the filters if these are ``filtered`` behind, and else counts as noise of the sensors.
    """
    shapes, omega = modal.mode_shapes, modal.natural_frequencies
    accelerated = on_velocities(rows.acceleration @ shapes)
    C = outputs(rows.position @ shapes / omega, rows.rate @ shapes, accelerated, plant.A)
    static = static_feedthrough(rows, modal, forces)
    through = load_feedthrough(rows, modal, line_load)
    if full_scale is None:
        full_scale = _ranges(plant, C, through, rows, sensors, current_range)
    shares = np.array([noise if each.noise is None else each.noise for each in sensors])[rows.item]
    felt = np.zeros((len(C), len(C))) if filtered else through @ plant.process_noise @ through.T
    return replace(
        plant,
        C=sealed(C),
        D=sealed(accelerated @ plant.B + static),
        sensor_noise=sealed(np.diag((shares * full_scale) ** 2) * plant.control_interval + felt),
        sensor_full_scale=sealed(np.array(full_scale)),
        sensors=rows.signals,
    )


def _ranges(
    plant: Plant, C: Array, through: Array, rows: SensorRows, sensors: Sequence[Sensor], current_range: float | None
) -> Array:
    """(p,): what each sensor says, or the margin times the largest of its readings after a sudden reference load, undriven."""
    largest = FULL_SCALE_MARGIN * _largest_readings(plant, C, through)
    found = []
    for k, sensor in enumerate(sensors):
        own = current_range if isinstance(sensor, PatchCurrent) and sensor.range is None else sensor.range
        fitted = float(largest[rows.item == k].max())
        if own is None and not fitted**2 > 0.0:  # squares of readings must be numbers
            raise Refused(f"blade.sensors[{k}].range", own, "given where the blade's reference load moves no reading of the sensor")
        found.append(fitted if own is None else own)
    return np.array(found)[rows.item]


def _largest_readings(plant: Plant, C: Array, through: Array) -> Array:
    """(p,): in five periods of the first mode from rest under the reference load in each direction."""
    steps = int(np.ceil(5.0 * 2.0 * np.pi / plant.natural_frequencies[0] / plant.control_interval))
    every = -(-steps // MOST_SAMPLES)
    transition = expm(plant.A * (every * plant.control_interval))
    load = np.diag(np.asarray(plant.reference_load))
    displaced = -np.linalg.solve(plant.A, plant.disturbance_input @ load)
    offset, largest = -displaced, np.zeros(len(C))
    for _ in range(-(-steps // every) + 1):
        largest = np.maximum(largest, np.abs(C @ (displaced + offset) + through @ load).max(axis=1))
        offset = transition @ offset
    return np.asarray(largest)
