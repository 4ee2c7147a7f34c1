"""What can be said of the loop that LQG closes, on the plant that it is designed for; computed by ``baselines.analysis``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from baselines.analysis.frequency_response import frequency_response, resonant_angles
from baselines.analysis.margins import StabilityMargins, stability_margins
from baselines.analysis.stationary import closed_loop_poles, stationary_cost
from baselines.design.linear import LinearController
from baselines.design.loop import closed_loop, sampled
from baselines.laws.lqg import lqg
from baselines.laws.no_control import no_control
from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import THESIS
from beamenv.configuration import Count, checked
from beamenv.plant.plant import Plant, drive_limit
from train.explore.blade import blade_of
from train.explore.settings import Settings

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

LOWEST = 0.1
"""Where frequency responses begin, over the lowest natural frequency."""
PLACES: tuple[tuple[str, Literal["input", "output"]], ...] = (("voltages", "input"), ("readings", "output"))


@dataclass(frozen=True, slots=True, eq=False)
class Loop:
    """Of a plant with m voltages and p readings, without control and under LQG."""

    poles: Mapping[str, Complex]
    """rad/s, by the controller."""
    margins: Mapping[str, StabilityMargins]
    """By where the loops are broken: at the voltages, at the readings."""
    cost: float
    """J per second in the long run over that without control, by the plant's own weights: under LQG."""
    least_cost: float
    """Likewise, under LQG with the plant's own weights."""
    frequencies: Array
    """(k,), rad/s, up to half the sampling rate."""
    bode: Mapping[str, Complex]
    """(k,), full scales of the reading per limit of the drive, by the controller, which adds to the voltage."""
    plant_gains: Array
    """(k, min(m, p)): singular values from voltages to readings, full scales per drive limit, without control."""
    load_gains: Mapping[str, Array]
    """(k,), m per N/m: the largest singular value from line loads to the tip, by the controller."""
    sensitivity: Mapping[str, Array]
    """(k,), by where the loops are broken: the largest singular value of S, in units of the drive limits or of full scales."""
    pair: tuple[int, int]
    """Numbers of the voltage and the reading of the Bode diagram."""


def loop(settings: Settings, base: BladeConfig = THESIS) -> Loop:
    """Everything that the page says of the loop; ``ValueError``, in one sentence, where there is none."""
    plant = blade_of(settings, base).plant
    m, p = plant.B.shape[1], len(plant.C)
    voltage = checked("settings.actuator", settings.actuator, Count(1, m))
    reading = checked("settings.sensor", settings.sensor, Count(1, p))
    idle, own = no_control(plant), lqg(plant)
    Q, R = settings.weights(plant)
    law = own if Q is None and R is None else lqg(plant, Q=Q, R=R)
    laws = {idle.name: idle, law.name: law}
    idle_cost, cost, least = (stationary_cost(plant, each) for each in (idle, law, own))
    angles = _angles(plant)
    responses = {name: _answers(plant, each, angles) for name, each in laws.items()}
    return Loop(
        poles={name: closed_loop_poles(plant, each) for name, each in laws.items()},
        margins={where: stability_margins(plant, law, at) for where, at in PLACES},
        cost=cost / idle_cost,
        least_cost=least / idle_cost,
        frequencies=angles / plant.control_interval,
        bode={name: each[:, reading - 1, voltage - 1] for name, each in responses.items()},
        plant_gains=np.asarray(np.linalg.svd(responses[idle.name], compute_uv=False), dtype=np.float64),
        load_gains={name: _load_gains(plant, each, angles) for name, each in laws.items()},
        sensitivity=_sensitivity(plant, law, angles),
        pair=(voltage, reading),
    )


def _angles(plant: Plant) -> Array:
    """Rad a sample: as dense as the blade's resonances are sharp, from below the first of them to half the sampling rate."""
    least = LOWEST * plant.natural_frequencies[0] * plant.control_interval
    around = resonant_angles(sampled(plant).A)
    return np.concatenate([np.geomspace(least, around[around > least][0], 60, endpoint=False), around[around > least]])


def _answers(plant: Plant, law: LinearController, angles: Array) -> Complex:
    """(k, p, m): readings, in full scales, of what is added to the voltages, in drive limits, once it has gone round the loop."""
    held = sampled(plant, law)
    added = _padded(held.B * drive_limit(plant), law)
    seen = _padded((held.C / plant.sensor_full_scale[:, None]).T, law).T
    return frequency_response(closed_loop(held, law)[0], added, seen, np.zeros((len(seen), added.shape[1])), angles)


def _sensitivity(plant: Plant, law: LinearController, angles: Array) -> dict[str, Array]:
    """(k,): of S = (I − K P)⁻¹ at the voltages and (I − P K)⁻¹ at the readings."""
    held, drive, full = sampled(plant, law), drive_limit(plant), plant.sensor_full_scale
    (m, p), K = (held.B.shape[1], len(held.C)), law.measurement_gain
    A, B = law.transition + law.voltage_input @ law.state_gain, law.measurement_input + law.voltage_input @ K
    P = frequency_response(held.A, held.B * drive, held.C / full[:, None], np.zeros((p, m)), angles)
    answer = frequency_response(A, B * full, law.state_gain / drive[:, None], K * full / drive[:, None], angles)
    loops = dict(zip((where for where, _ in PLACES), (answer @ P, P @ answer), strict=True))
    least = {where: np.linalg.svd(np.eye(each.shape[-1]) - each, compute_uv=False)[:, -1] for where, each in loops.items()}
    return {where: np.asarray(1.0 / each, dtype=np.float64) for where, each in least.items()}


def _load_gains(plant: Plant, law: LinearController, angles: Array) -> Array:
    """(k,), m per N/m."""
    held = sampled(plant, law)
    tip = np.zeros((len(plant.tip_displacement), len(held.A)))
    tip[:, : len(plant.A)] = plant.tip_displacement
    loads, seen = _padded(held.disturbance_input, law), _padded(tip.T, law).T
    response = frequency_response(closed_loop(held, law)[0], loads, seen, np.zeros((len(seen), loads.shape[1])), angles)
    return np.asarray(np.linalg.norm(response, ord=2, axis=(1, 2)))


def _padded(columns: Array, law: LinearController) -> Array:
    """With a row of zeros for each number of the law's memory."""
    return np.vstack([columns, np.zeros((law.order, columns.shape[1]))])
