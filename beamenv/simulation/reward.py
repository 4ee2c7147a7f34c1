"""The scale of rewards: a property of the plant."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.plant.plant import Plant, drive_limit
from beamenv.plant.transients import after_sudden
from beamenv.scenarios.load_cases import static_deflection

Array = NDArray[np.float64]


def reward_scale(plant: Plant) -> float:
    """Cost of one control interval, J s, that is a reward of −1: xᵀQx Δt in the static deflection under 30 N/m in flap, or of any
    plant under the reference load of the last disturbance that load cases are made of.

    It depends on the plant alone, so the return of an episode is −J over a constant whatever the scenario and the controller.
    Without control a default episode comes to about −1 a step, 6.7 µJ s for the default blade. A plant whose energy is not known
    may cost nothing at rest: then it is the greatest xᵀQx after that load has suddenly set in, or after full voltages where there
    is no load.
    """
    scale = _scale(plant) * plant.control_interval
    if not (np.isfinite(scale) and scale > 0.0):
        raise ValueError("plant costs nothing under its reference load: its energy or output weight must weigh what that moves.")
    return scale


def _scale(plant: Plant) -> float:
    if not plant.loads:
        return after_sudden(plant, plant.B @ drive_limit(plant)[:, None]).cost
    load = np.zeros(plant.disturbance_input.shape[1])
    load[plant.loads - 1] = np.asarray(plant.reference_load)[plant.loads - 1]
    if not plant.energy_known:
        return after_sudden(plant, (plant.disturbance_input @ load)[:, None]).cost
    state = static_deflection(plant, load)
    return float(state @ plant.state_weight @ state)
