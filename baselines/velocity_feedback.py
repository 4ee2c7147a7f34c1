"""Collocated negative velocity feedback: each actuator opposes the strain rate that its own sensor feels."""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from baselines.controller import Array, LinearController, static_law
from baselines.stationary import stationary_cost
from beamenv.plant import Plant

_DECADES = np.linspace(-6.0, 1.0, 36)


def velocity_feedback(plant: Plant, gain: float | None = None) -> LinearController:
    """u_j = −g y_j, where y_j is the current of the sensor under actuator j; ganged drive (m = 1) takes the sensors' mean.

    ``gain`` g is in V/A. By default it is the one with the least stationary cost under the plant's white loads and sensor noise,
    found from the plant alone; only gains that keep the sampled loop stable qualify. The thesis' sensors lie across the section
    from their actuators and so feel bending alike but extension with the opposite sign: its modes bound the gain. Raises
    ValueError when sensors and actuators cannot be paired.
    """
    pairing = _pairing(plant)
    if gain is None:
        gain = _least_cost_gain(plant, pairing)
    return static_law(plant, "velocity feedback", -gain * pairing)


def _pairing(plant: Plant) -> Array:
    """(m, p): which sensor each actuator answers, signed so that a positive gain takes energy out."""
    m, p = plant.B.shape[1], len(plant.C)
    if m not in (1, p):
        raise ValueError(
            f"plant has {m} actuators and {p} sensors, which velocity feedback cannot pair: "
            "it needs one sensor to each actuator, or one ganged actuator"
        )
    pairing = np.eye(p) if m == p else np.full((1, p), 1.0 / p)
    return pairing * np.sign(np.diag(pairing @ plant.C @ plant.B))[:, None]


def _least_cost_gain(plant: Plant, pairing: Array) -> float:
    collocated = np.abs(np.diag(pairing @ plant.C @ plant.B)).max()
    unit = float(plant.natural_frequencies[0] / collocated)  # damps at about the first mode's own rate

    def cost(decade: float) -> float:
        return stationary_cost(plant, static_law(plant, "trial", -unit * 10.0**decade * pairing))

    costs = [cost(decade) for decade in _DECADES]
    best = int(np.argmin(costs))
    bracket = _DECADES[max(best - 1, 0)], _DECADES[min(best + 1, len(_DECADES) - 1)]
    found = minimize_scalar(cost, bounds=bracket, method="bounded", options={"xatol": 1e-4})
    return unit * 10.0 ** float(found.x if found.fun <= costs[best] else _DECADES[best])
