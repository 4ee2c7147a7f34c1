"""What states and loads of a blade amount to: units of what networks are shown."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_discrete_lyapunov

from beamenv.plant.plant import drive_limit, sample
from beamenv.task import Task

Array = NDArray[Any]

LOAD_UNIT = np.float32(20.0)
"""N/m, of the loads that a critic is shown."""


def typical_state(task: Task, reference: float | None = None) -> Array:
    """(n,) standard deviations, √J, under the white load and white voltages of a fifth of the drive limit.

    Where an episode without control costs more than these amount to, ``reference`` in J s, they are enlarged to its measure.
    """
    held = sample(task.plant)
    drive = held.B * (0.2 * drive_limit(task.plant))
    excitation = drive @ drive.T + held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    variance = np.diag(solve_discrete_lyapunov(held.A, excitation))
    energy = 0.5 * float(variance[: task.plant.blade_states].sum()) * task.steps * held.interval
    return np.sqrt(variance * max(1.0, (reference or 0.0) / energy))
