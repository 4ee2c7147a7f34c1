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
"""Root mean square of each number in a law's memory under white and lasting loads: that of what a network is fed well with."""


class LinearBase(NamedTuple):
    """[ξ, y'] @ fused = [ξ⁺ before feedback, voltages], as ``train.controllers.policies.StateSpacePolicy`` has it.

    On the design plant under its white noise and ``PersistentLoad()`` each number of ξ is ``SPREAD``, root mean square.
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


def belief_base(kind: str, task: Task) -> tuple[LinearBase, Array]:
    """The same, and root mean squares (p,) of the innovations y − C ξ there."""
    law, readout = _law(kind, task)
    return _scaled(law, readout, task.design.full_plant), innovations_of(law, readout, task.design.full_plant)


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


def _spread(law: LinearController, plant: Plant) -> tuple[Array, Array]:
    """Covariance of [x, load, ξ] in the closed loop, and C (p, n + 2)."""
    held = sampled_with_loads(plant, PersistentLoad())
    transition, noise_input, _, _, covariance = closed_loop(held, law)
    return solve_discrete_lyapunov(transition, noise_input @ covariance @ noise_input.T), held.C


def _scaled(law: LinearController, readout: Array, plant: Plant) -> LinearBase:
    fused, feedback = law.matrices
    order = law.order
    unit = np.sqrt(np.diag(_spread(law, plant)[0])[-order:]) / SPREAD
    into, out = np.concatenate([unit, np.ones(len(fused) - order)]), np.concatenate([1.0 / unit, np.ones(fused.shape[1] - order)])
    return LinearBase(into[:, None] * fused * out, feedback / unit, unit[:, None] * readout)


def innovations_of(law: LinearController, readout: Array, plant: Plant) -> Array:
    """(p,) root mean squares of y − C ξ under white and lasting loads, in full scales."""
    covariance, C = _spread(law, plant)
    scale = plant.sensor_full_scale
    seen = np.hstack([C / scale[:, None], -readout.T])
    noise = np.diag(plant.sensor_noise) / plant.control_interval / scale**2
    return np.asarray(np.sqrt(np.einsum("ij,jk,ik->i", seen, covariance, seen) + noise))
