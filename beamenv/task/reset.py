"""The options of a reset."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import checked_table
from beamenv.configuration.arrays import real_numbers
from beamenv.scenarios.scenario import Scenario, with_load
from beamenv.task.scenario_checks import check_loads
from beamenv.task.task import Task

Array = NDArray[np.float64]


def reset_options(task: Task, options: Mapping[str, Any] | None, rows: int) -> tuple[Scenario, Array | None]:
    """Scenario and initial states ((n,) or (rows, n), or None) of one reset, as its options say."""
    options = {} if options is None else checked_table("options", options, ("load", "initial_state"))
    chosen = task.scenario
    if "load" in options:
        chosen = with_load(chosen, options["load"])
        check_loads(chosen, task.blade, "options.load")
    return chosen, _initial_state(task, options["initial_state"], rows) if "initial_state" in options else None


def _initial_state(task: Task, value: Any, rows: int) -> Array:
    plant, state = task.plant, real_numbers("options.initial_state", value)
    n, b = len(plant.A), plant.blade_states
    if state.shape not in ((n,), (rows, n), (b,), (rows, b)):
        alone = f", or ({b},) or ({rows}, {b}), the blade's own states" if b < n else ""
        raise ValueError(f"options.initial_state has shape {state.shape}, but must have shape ({n},) or ({rows}, {n}){alone}.")
    if state.shape[-1] < n:
        state = np.concatenate([state, np.zeros((*state.shape[:-1], n - b))], axis=-1)
    strain = np.abs(task.blade.standing_strain + state @ plant.strain.T).max(initial=0.0)
    limit = task.config.patches.failure_strain
    if not (np.isfinite(state).all() and strain <= limit):
        raise ValueError(f"options.initial_state strains the blade by {strain:.3g}, but must be finite and stay below {limit:.3g}.")
    return state
