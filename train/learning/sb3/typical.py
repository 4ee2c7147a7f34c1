"""What states and loads of a blade amount to: units of what networks are shown."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_discrete_lyapunov

from beamenv.plant.plant import Plant, drive_limit, sample
from beamenv.task import Task

Array = NDArray[Any]

LOAD_UNIT = np.float32(20.0)
"""N/m, of the loads that a critic is shown; of other disturbances as much as stands for it (``Plant.load_scale``)."""


def typical_state(task: Task, reference: float | None = None) -> Array:
    """(n,) standard deviations, √J, under the white load and white voltages of a fifth of the drive limit.

    Where an episode without control costs more than these amount to, ``reference`` in J s, they are enlarged to its measure.
    """
    held = sample(task.plant)
    drive = held.B * (0.2 * drive_limit(task.plant))
    excitation = drive @ drive.T + held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    spread = solve_discrete_lyapunov(held.A, excitation)
    variance = np.diag(spread)
    if task.plant.in_energy_coordinates:
        power = 0.5 * float(variance[: task.plant.blade_states].sum())
    else:
        power = float(np.sum(task.plant.state_weight * spread))
    return np.sqrt(np.where(variance > 0.0, variance, 1.0) * max(1.0, (reference or 0.0) / (power * task.steps * held.interval)))


def load_unit(plant: Plant) -> Array:
    """(k,): the unit of each disturbance, of one that is noise alone its standard deviation."""
    noise = np.sqrt(np.diag(plant.process_noise) / plant.control_interval)
    units = np.where(plant.load_scale > 0.0, float(LOAD_UNIT) * plant.load_scale, np.where(noise > 0.0, noise, 1.0))
    return units.astype(np.float32)


def shown_states(plant: Plant, modes: int) -> list[int]:
    """Displacements and velocities of a blade's slowest ``modes``; of a model in coordinates of its own all states."""
    if not plant.in_energy_coordinates:
        return list(range(len(plant.A)))
    half = plant.blade_states // 2
    return [*range(modes), *range(half, half + modes)]
