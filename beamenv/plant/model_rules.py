"""What a model does not tell, by stated rules from what it does: each says in words what it took to be so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import block_diag, solve_continuous_lyapunov

from beamenv.configuration import Refused
from beamenv.configuration.arrays import checked_array
from beamenv.configuration.read_only import sealed
from beamenv.plant.matrices import PlantMatrices
from beamenv.plant.model_arguments import checked_covariance, checked_weight, positive
from beamenv.plant.parts import not_negative
from beamenv.plant.transients import after_sudden
from beamenv.plant.units import AnyPlant, drive_limit

Array = NDArray[np.float64]

ANGLE = 1.4
"""rad between two samples of the fastest mode, as on the default blade."""

OUTPUTS = "the cost is of outputs, each over the most that one full voltage makes of it, for no energy is known"

LONGEST = 1.0
"""s: control interval of a model, however slow it is."""

OSCILLATES = 0.5
"""Damping ratio below which a mode counts as one."""

MARGIN = 2.0
"""Full scale over the largest reading after full voltages or the reference load: resonance exceeds a step."""

WHITE_LOAD = 0.1
"""Standard deviation of the white disturbance of an interval over the reference load."""

NOISE = 0.02
"""Standard deviation of one reading's noise over full scale."""

EFFORT = 0.2
"""What full voltage of one actuator costs, over the most that the reference load does; 0.21 on the default blade."""


def usual_interval(A: Array, interval: float | None) -> tuple[float, tuple[str, ...]]:
    """The control interval, s, and what is to be said of it."""
    if interval is not None:
        return interval, ()
    poles = np.linalg.eigvals(A)
    turning = poles[(poles.imag > 0.0) & (-poles.real < OSCILLATES * np.abs(poles))]
    found = min(float(f"{ANGLE / np.abs(turning if len(turning) else poles).max():.2g}"), LONGEST)
    return found, (f"interval = {found:g} s: {ANGLE:g} rad of the fastest mode",)


def turning_frequencies(A: Array) -> Array:
    """(r,), rad/s, ascending: of the poles that turn, or of all where none does."""
    poles = np.linalg.eigvals(A)
    turning = poles[poles.imag > 0.0]
    return np.sort(np.abs(turning if len(turning) else poles))


def slowest_mode(A: Array) -> float:
    """Frequency (rad/s) of what swings, or else the least of all frequencies."""
    poles = np.linalg.eigvals(A)
    light = poles[(poles.imag > 0.0) & (-poles.real < OSCILLATES * np.abs(poles))]
    return float(np.abs(light).min()) if len(light) else float(turning_frequencies(A)[0])


def with_cost(
    plant: AnyPlant, energy: ArrayLike | None, output_weight: ArrayLike | None, further: int, assumed: list[str]
) -> AnyPlant:
    """The cost of states: the energy, or of outputs where that is asked for or no energy is known."""
    n = len(plant.A)
    if energy is not None:
        of_model = checked_array("energy", energy, (n - further, n - further), "a row and a column for each state")
        known = block_diag(not_negative("energy", of_model), np.zeros((further, further)))
        plant = replace(plant, energy=sealed(known), state_weight=sealed(known))
    if energy is not None and output_weight is None:
        return plant
    if output_weight is None:
        output_weight = usual_output_weight(plant)
        assumed.append(OUTPUTS)
    W = checked_weight("output_weight", output_weight, len(plant.C), "sensor")
    return of_outputs(plant, W)


def usual_output_weight(plant: PlantMatrices) -> Array:
    """(p,): of each output over the most that one full voltage makes of it."""
    drive = drive_limit(plant)
    reach = np.maximum(after_sudden(plant, plant.B * drive).outputs, np.abs(plant.D * drive).max(axis=1))
    return np.asarray(1.0 / np.where(reach > 0.0, reach, 1.0) ** 2)


def of_outputs(plant: AnyPlant, weight: Array) -> AnyPlant:
    """The plant with the cost yᵀWy of its outputs, W = ``weight`` (p, p)."""
    return replace(
        plant,
        state_weight=sealed(plant.C.T @ weight @ plant.C),
        cross_weight=sealed(plant.C.T @ weight @ plant.D),
        input_weight=sealed(plant.D.T @ weight @ plant.D),
    )


def priced_alike(plant: AnyPlant, first: PlantMatrices) -> AnyPlant:
    """The plant with the cost of outputs that the first one has by the rules; as it is where that was said otherwise."""
    if OUTPUTS not in first.assumed:
        return plant
    return replace(of_outputs(plant, np.diag(usual_output_weight(first))), input_weight=first.input_weight)


def with_scales(
    plant: AnyPlant,
    reference: ArrayLike | None,
    full_scale: ArrayLike | None,
    at_actuators: bool,
    loads: int,
    assumed: list[str],
) -> AnyPlant:
    """What the actuators can hold, and the range of the sensors."""
    drive, rest = drive_limit(plant), np.zeros(plant.disturbance_input.shape[1] - loads)
    if reference is None:
        held = drive if at_actuators else _held_by(plant, drive)[:loads]
        assumed.append(
            f"reference_load = {_several(held)}: {'full voltage' if at_actuators else 'what costs as much as full voltages'}"
        )
    else:
        held = positive("reference_load", reference, loads, "disturbance")
    plant = replace(plant, reference_load=sealed(np.append(held, rest)))
    if full_scale is None:
        forces = np.hstack([plant.B * drive, plant.disturbance_input[:, :loads] * held])
        ranges = MARGIN * (after_sudden(plant, forces).outputs + np.abs(plant.D * drive).max(axis=1))
        ranges = np.where(ranges > 0.0, ranges, 1.0)
        assumed.append(f"full_scale = {_several(ranges)}: twice the largest reading after one full voltage or reference load")
    else:
        ranges = positive("full_scale", full_scale, len(plant.C), "sensor")
    return replace(plant, sensor_full_scale=sealed(ranges))


def _held_by(plant: PlantMatrices, drive: Array) -> Array:
    """(k,): disturbances whose impulse costs as much as one of all actuators at full voltage; 34.5 and 35.4 N/m on the default
    blade, whose reference is 30.
    """
    to_come = solve_continuous_lyapunov(plant.A.T, -np.asarray(plant.state_weight))
    by_drive, by_load = (np.einsum("ik,ij,jk->k", f, to_come, f) for f in (plant.B * drive, plant.disturbance_input))
    return np.sqrt(by_drive.sum() / np.where(by_load > 0.0, by_load, by_drive.sum()))


def with_price(plant: AnyPlant, given: ArrayLike | None, assumed: list[str]) -> AnyPlant:
    """The price of voltages, beside what outputs feel of them."""
    m, felt = (
        plant.B.shape[1],
        plant.input_weight if np.any(plant.cross_weight) or plant.D.any() else np.zeros_like(plant.input_weight),
    )
    if given is None:
        forces = plant.disturbance_input[:, : plant.loads] * np.asarray(plant.reference_load)[: plant.loads]
        most = after_sudden(plant, forces).cost
        price = np.diag(EFFORT * most / drive_limit(plant) ** 2)
        assumed.append(f"input_weight: one full voltage costs {EFFORT:g} of the most that the reference load does")
    else:
        price = checked_weight("input_weight", given, m, "voltage")
        if not np.linalg.eigvalsh(price).min() > 0.0:
            raise Refused("input_weight", price.tolist(), "positive definite")
    return replace(plant, input_weight=sealed(price + felt))


def with_noise(plant: AnyPlant, process: ArrayLike | None, sensor: ArrayLike | None, loads: int, assumed: list[str]) -> AnyPlant:
    """Intensities of white disturbances and of sensor noise, from covariances or standard deviations in one interval."""
    interval, states = plant.control_interval, plant.disturbance_input.shape[1] - loads
    if process is None:
        white = np.diag((WHITE_LOAD * np.asarray(plant.reference_load)[:loads]) ** 2) * (0.0 if states else 1.0)
        if not states:
            assumed.append(f"process_noise: {WHITE_LOAD:g} of the reference load, white")
    else:
        white = checked_covariance("process_noise", process, loads, "disturbance")
    if sensor is None:
        noise = np.diag((NOISE * plant.sensor_full_scale) ** 2)
        assumed.append(f"sensor_noise: {NOISE:g} of full scale")
    else:
        noise = checked_covariance("sensor_noise", sensor, len(plant.C), "sensor")
    return replace(
        plant,
        process_noise=sealed(block_diag(white, np.eye(states)) * interval if states else white * interval),
        sensor_noise=sealed(noise * interval),
    )


def _several(values: Array) -> str:
    return ", ".join(f"{each:.4g}" for each in values)
