"""The linear laws that policies start from or add to, as matrices of normalised readings and voltages."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

from baselines import LinearController, PersistentLoad, RotorHarmonics, reference_lqg
from baselines.design.controller import Array
from baselines.design.load_model import Load
from baselines.design.loop import closed_loop
from baselines.laws.lqg import sampled_with_loads
from baselines.laws.reduction import balanced
from baselines.laws.reference_lqg import full_order_lqg
from beamenv.configuration import Refused
from beamenv.plant.plant import Plant
from beamenv.task import Task

BASES = ("lqg", "lqg-load", "lqg-rotor")

SPREAD = 0.3
"""Root mean square, under white and lasting loads, of the number in a law's memory that moves most."""


class LinearBase(NamedTuple):
    """[ξ, y'] @ fused = [ξ⁺ before feedback, voltages], as ``train.controllers.policies.StateSpacePolicy`` has it.

    ξ is balanced, as its reduction left it: each number is as large in the loop as it tells on the cost, by one factor that makes
    the largest ``SPREAD``. So equal steps of an optimiser in all gains are equal shares of what they do. (Numbers scaled to equal
    root mean squares have gains from 0.5 down to 0.003, and errors in those from the high modes destabilise.)
    """

    fused: Array
    """(s + p, s + m)"""
    feedback: Array
    """(m, s)"""
    readout: Array
    """(s, p): ξ to the readings it predicts."""


def linear_base(kind: str, task: Task) -> LinearBase:
    """The reference LQG of a task's design: "lqg", "lqg-load" (with load estimate) or "lqg-rotor" (with the rotor's harmonics)."""
    return _scaled(*_law(kind, task), task.design.full_plant)


def _law(kind: str, task: Task) -> tuple[LinearController, Array]:
    """The law, and what its memory says of the readings (s, p), in full scales."""
    speed, plant = task.design_config.speed, task.design.full_plant
    if kind == "lqg":
        return _with_readout(plant)
    if kind == "lqg-load":
        return _with_readout(plant, PersistentLoad())
    if kind == "lqg-rotor" and speed:
        return _with_readout(plant, RotorHarmonics(speed), PersistentLoad())
    raise Refused("base", kind, "one of lqg, lqg-load and, on a rotor that turns, lqg-rotor")


def _with_readout(plant: Plant, *loads: Load) -> tuple[LinearController, Array]:
    law, whole = reference_lqg(plant, load=loads), full_order_lqg(plant, load=loads)
    held = sampled_with_loads(plant, *loads)
    output = np.hstack([held.C, np.zeros((len(held.C), whole.order - len(held.A)))])  # behind the state are the voltages before
    if law.order < whole.order:
        output = output @ balanced(held, whole)[0][:, : law.order]
    return law, output.T / plant.sensor_full_scale


def _scaled(law: LinearController, readout: Array, plant: Plant) -> LinearBase:
    fused, feedback = law.matrices
    held = sampled_with_loads(plant, PersistentLoad())
    transition, noise_input, _, _, covariance = closed_loop(held, law)
    spread = np.diag(solve_discrete_lyapunov(transition, noise_input @ covariance @ noise_input.T))[-law.order :]
    unit = np.sqrt(spread.max()) / SPREAD
    scale = np.where(np.arange(len(fused)) < law.order, unit, 1.0)
    other = np.where(np.arange(fused.shape[1]) < law.order, unit, 1.0)
    return LinearBase(scale[:, None] * fused / other, feedback / unit, unit * readout)
