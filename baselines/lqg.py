"""LQG: Kalman filter and regulator, as the sampled-data optimum or as the thesis' continuous design."""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.linalg import expm

from baselines.controller import LinearController, drive_scale
from baselines.persistent_load import PersistentLoad, with_persistent_load
from baselines.riccati import Array, kalman_filter, regulator, sampled_kalman_filter, sampled_regulator
from beamenv.plant import Plant, sample


def lqg(
    plant: Plant, design: Literal["sampled", "continuous"] = "sampled", persistent_load: PersistentLoad | None = None
) -> LinearController:
    """LQG controller of a design plant; its filter starts from its own estimate, zero.

    ``design="sampled"``: the optimum for the cost and the noise of the environment, both exactly sampled, with y_k used for u_k:
    x̂ ← x̂ + L (y − C x̂), u = −K x̂, x̂⁺ = A x̂ + B u.

    ``design="continuous"``: the thesis' Eqs. 5.11 and 5.18–5.21, x̂̇ = (A − LC) x̂ + B u + L y, u = −K x̂, implemented with y and u
    held over each interval, the filter integrated exactly. It thus answers y_k one interval late.

    ``persistent_load`` (sampled design only) adds a load that lasts to the state, for filter and regulator alike.
    Raises ValueError for another design, or for a persistent load with the continuous one.
    """
    if design == "sampled":
        return _sampled(plant, persistent_load)
    if design != "continuous":
        raise ValueError(f'design = {design!r} is not an LQG design: allowed are "sampled" and "continuous"')
    if persistent_load is not None:
        raise ValueError(f'persistent_load = {persistent_load} needs design="sampled": the thesis\' design has no load state')
    return _continuous(plant)


def _sampled(plant: Plant, load: PersistentLoad | None) -> LinearController:
    held = sample(plant) if load is None else with_persistent_load(sample(plant), load)
    E = held.disturbance_input
    _, K = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    _, L = sampled_kalman_filter(held.A, held.C, E @ held.process_noise @ E.T, held.sensor_noise)
    correct = np.eye(len(held.A)) - L @ held.C
    name = "LQG" if load is None else "LQG with load estimate"
    return _observer(plant, name, held.A @ correct, held.A @ L, held.B, -K @ correct, -K @ L)


def _continuous(plant: Plant) -> LinearController:
    E, n, p = plant.disturbance_input, len(plant.A), len(plant.C)
    _, K = regulator(plant.A, plant.B, plant.state_weight, plant.input_weight)
    _, L = kalman_filter(plant.A, plant.C, E @ plant.process_noise @ E.T, plant.sensor_noise)
    dynamics = np.zeros((n + p + plant.B.shape[1],) * 2)
    scale = np.concatenate([np.ones(n), plant.sensor_full_scale, drive_scale(plant)])  # keeps the exponential well scaled
    dynamics[:n] = np.hstack([plant.A - L @ plant.C, L, plant.B]) * scale
    held = expm(dynamics * plant.control_interval)[:n] / scale
    return _observer(plant, "LQG (thesis)", held[:, :n], held[:, n : n + p], held[:, n + p :], -K, np.zeros((len(K), p)))


def _observer(plant: Plant, name: str, F: Array, G: Array, H: Array, M: Array, T: Array) -> LinearController:
    return LinearController(
        name=name,
        transition=F,
        measurement_input=G,
        voltage_input=H,
        state_gain=M,
        measurement_gain=T,
        measurement_scale=plant.sensor_full_scale,
        voltage_scale=drive_scale(plant),
        voltage_limits=plant.voltage_limits,
    )
