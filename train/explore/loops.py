"""Damping and step response of the blade alone and under LQG: u = −K x̂ with x̂ ← x̂ + L (y − C x̂), x̂⁺ = A x̂ + B u."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from baselines.analysis.response import linear_response
from baselines.design.loop import spectral_radius
from baselines.laws.lqg import compensator
from beamenv.plant.plant import Plant, SampledPlant

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Damping:
    """Of a blade with r modes. By the separation principle a loop's poles are its regulator's and its filter's."""

    free: Array
    """(r,): damping ratios of the modes without control, in ascending order of their frequencies."""
    controlled: Array
    """(r,): of the same modes under LQG: of the regulator's poles."""
    filter_rate: float
    """1/s: at least this fast the error of the Kalman filter decays."""


def damping(plant: Plant, held: SampledPlant, K: Array, L: Array) -> Damping:
    """Damping of a plant without control and, sampled, with gains K (m, n) and L (n, p), of whose states the first are its own.

    The others are what readings show of the voltages before, which moves nothing. A mode above half the sampling rate shows in
    samples as a slower one: each pole of the loop is taken for the mode that has the greatest part in it, where it is nearest to
    that mode's.
    """
    free, modes = np.linalg.eig(plant.A)
    own = np.s_[: len(free), : len(free)]
    poles, shapes = np.linalg.eig((held.A - held.B @ K)[own])
    parts = np.abs(np.linalg.solve(modes, shapes))
    mode, pole = linear_sum_assignment(-parts / np.linalg.norm(parts, axis=0))
    of_modes = np.empty_like(free)
    of_modes[mode] = _unfolded(poles[pole], free[mode], held.interval)
    upper = np.flatnonzero(free.imag > 0.0)
    upper = upper[np.argsort(np.abs(free[upper]))]
    error = held.A - held.A @ L @ held.C
    return Damping(
        free=-free[upper].real / np.abs(free[upper]),
        controlled=-of_modes[upper].real / np.abs(of_modes[upper]),
        filter_rate=-float(np.log(spectral_radius(error))) / held.interval,
    )


def _unfolded(poles: Array, near: Array, interval: float) -> NDArray[np.complex128]:
    """log(z)/Δt, rad/s, of the sampled poles, each on the branch nearest to a continuous one."""
    with np.errstate(divide="ignore"):  # z = 0 is infinitely fast
        found = np.log(poles.astype(complex)) / interval
    turns = np.round((near.imag - found.imag) * interval / (2.0 * np.pi))
    return np.asarray(found + 2j * np.pi * turns / interval)


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
