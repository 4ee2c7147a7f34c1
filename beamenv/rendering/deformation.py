"""How any plant of a bank bends and twists along its span."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.changed import changed_blade
from beamenv.simulation.plants.banks import varied
from beamenv.simulation.plants.spin_up import Cycloid, SpinUp
from beamenv.simulation.plants.spin_ups import spin_up_of
from beamenv.task import Task

Array = NDArray[np.float64]


class Deformation:
    """Displacements at stations (k,), m from the root, of the plants that a task's episodes have."""

    def __init__(self, task: Task, stations: Array) -> None:
        self._task, self._stations = task, stations
        self._index, self._operator = -1, np.empty(0)
        plants = task.scenario.plants
        self._varied = varied(plants, task.config) if plants.varies else None
        self._spin_up: SpinUp | None = None
        if plants.spin_up is not None:
            self._spin_up = spin_up_of(task.blade, Cycloid(*plants.spin_up, task.steps * task.config.control_interval))

    def displacement(self, state: Array, plant: int) -> Array:
        """(3, k): lag, flap (m) and twist (rad) of a state (n,) of the plant at this place of the bank."""
        if plant != self._index:
            self._index, self._operator = plant, self._operator_of(plant)
        displaced: Array = self._operator @ state
        return displaced

    def _operator_of(self, plant: int) -> Array:
        """(3, k, n)."""
        if self._spin_up is not None:
            return self._running_operator(self._spin_up, plant)
        blade = self._task.blade
        if self._varied is not None:
            blade = blade.with_fixed_order()
            blade = blade.changed(changed_blade(blade.config, *self._varied[plant].tolist()))
        return blade.displacement_operator(self._stations)

    def _running_operator(self, spin_up: SpinUp, plant: int) -> Array:
        """In the energy coordinates at the begin of interval ``plant``: x = [Uᵀη; η̇] with U Uᵀ = K.

        The blade has come there with the shapes of the interval before, those of its middle.
        """
        blade, interval = self._task.blade, self._task.config.control_interval
        time, before = np.asarray(plant * interval), np.asarray(max(plant - 0.5, 0.5) * interval)
        root = np.linalg.cholesky(spin_up.stiffness(time))
        operator = blade.displacement_operator(self._stations).copy()
        rows = blade.beam.displacements(self._stations)
        r = len(root)
        lag_flap_twist = np.stack([rows["u"], rows["v"], rows["phi"]])
        operator[..., :r] = lag_flap_twist @ spin_up.shapes(before) @ np.linalg.inv(root).T
        return operator
