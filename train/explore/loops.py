"""Damping and step response of the blade alone and under LQG."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.plant import Plant, SampledPlant

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Damping:
    """Damping ratios (r,) of pairs of poles, each in ascending order of the poles' magnitude."""

    free: Array
    """Of the blade without control."""
    controlled: Array
    """Of the blade under LQG: the regulator's poles, A − BK."""
    filter: Array
    """Of the error of its Kalman filter, A − ALC: the loop's other poles."""


def damping(held: SampledPlant, K: Array, L: Array) -> Damping:
    """Damping of a sampled plant under u = −K x̂ with x̂ ← x̂ + L (y − C x̂)."""
    regulated, observed = held.A - held.B @ K, held.A - held.A @ L @ held.C
    return Damping(*(damping_ratios(matrix, held.interval) for matrix in (held.A, regulated, observed)))


def damping_ratios(transition: Array, interval: float) -> Array:
    """ζ = −Re s/|s| (r,) of the continuous equivalents s = log(z)/Δt of 2r poles z, one of each pair, slowest first.

    Where two real poles take the place of a pair, they may surround another one: then one of them stands for both.
    """
    poles = np.log(np.linalg.eigvals(transition).astype(complex)) / interval
    ordered = poles[np.argsort(np.abs(poles))][::2]
    return np.asarray(-ordered.real / np.abs(ordered))


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
    """Exact responses, without noise, to a uniform ``line_load`` (2,) in N/m, sampled over ``duration`` s.

    LQG's filter starts from zero and knows the voltages as the drive limits them.
    """
    steps = round(duration / held.interval) + 1
    push = held.disturbance_input @ line_load
    at_rest = np.linalg.solve(np.eye(len(held.A)) - held.A, push)
    free, controlled = np.empty((steps, len(push))), np.empty((steps, len(push)))
    volts = np.empty((steps, held.B.shape[1]))
    offset, x, estimate = -at_rest, np.zeros_like(push), np.zeros_like(push)
    low, high = plant.voltage_limits
    for step in range(steps):
        free[step], controlled[step] = offset, x
        estimate = estimate + L @ (held.C @ (x - estimate))
        volts[step] = u = np.minimum(np.maximum(-(K @ estimate), low), high)
        driven = held.B @ u
        x, estimate, offset = held.A @ x + driven + push, held.A @ estimate + driven, held.A @ offset
    tip = plant.tip_displacement
    return StepResponses(
        time=held.interval * np.arange(steps),
        free=(free + at_rest) @ tip.T,
        controlled=controlled @ tip.T,
        volts=volts,
        at_rest=tip @ at_rest,
    )
