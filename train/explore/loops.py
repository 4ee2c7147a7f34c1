"""Damping and step response of the blade alone and under LQG: u = −K x̂ with x̂ ← x̂ + L (y − C x̂), x̂⁺ = A x̂ + B u."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.analysis.response import linear_response
from baselines.design.loop import spectral_radius
from baselines.laws.lqg import compensator
from beamenv.plant.plant import Plant, SampledPlant
from beamenv.plant.poles import damping_ratios, poles_of_sampled

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Damping:
    """Of a blade with r modes. By the separation principle a loop's poles are its regulator's and its filter's."""

    free: Array
    """(r,): damping ratios without control, in ascending order of the poles' magnitude."""
    controlled: Array
    """(r,): under LQG, likewise: of the regulator's poles."""
    filter_rate: float
    """1/s: at least this fast the error of the Kalman filter decays."""


def damping(held: SampledPlant, K: Array, L: Array, states: int) -> Damping:
    """Damping of a sampled plant without control and with gains K (m, n) and L (n, p), of whose states so many are the blade's.

    The others are what readings show of the voltages before, which moves nothing.
    """
    own = np.s_[:states, :states]
    free, controlled = held.A[own], (held.A - held.B @ K)[own]
    error = held.A - held.A @ L @ held.C
    return Damping(
        free=damping_ratios(poles_of_sampled(free, held.interval)),
        controlled=damping_ratios(poles_of_sampled(controlled, held.interval)),
        filter_rate=-float(np.log(spectral_radius(error))) / held.interval,
    )


@dataclass(frozen=True, slots=True, eq=False)
class StepResponses:
    """What a line load that sets in at once does to a blade at rest."""

    time: Array
    """(K,), s."""
    free: Array
    """(K, 2), m: tip in lag and flap without control."""
    controlled: Array
    """(K, 2), m: under LQG."""
    volts: Array
    """(K, m): LQG's voltages, limited as the drive limits them."""
    at_rest: Array
    """(2,), m: where the tip comes to rest without control."""


def step_responses(plant: Plant, held: SampledPlant, K: Array, L: Array, line_load: Array, duration: float) -> StepResponses:
    """Exact responses, without noise, to a uniform ``line_load`` (2,) in N/m, sampled over ``duration`` s."""
    steps, tip, n = round(duration / held.interval) + 1, plant.tip_displacement, len(plant.A)
    push = held.disturbance_input @ line_load
    at_rest: Array = np.asarray(np.linalg.solve(np.eye(len(held.A)) - held.A, push), dtype=np.float64)
    states, volts = linear_response(held, compensator(plant, "LQG", held, K, L), np.tile(line_load, (steps, 1)))
    return StepResponses(
        time=held.interval * np.arange(steps, dtype=np.float64),
        free=(at_rest - powers(held.A, at_rest, steps))[:, :n] @ tip.T,
        controlled=states[:-1, :n] @ tip.T,
        volts=volts,
        at_rest=tip @ at_rest[:n],
    )


def powers(transition: Array, start: Array, steps: int) -> Array:
    """(steps, n): Aᵏ x for k = 0, 1, …, by doubling."""
    rows, power = start[None], transition
    while len(rows) < steps:
        rows, power = np.vstack([rows, rows @ power.T]), power @ power
    return rows[:steps]
