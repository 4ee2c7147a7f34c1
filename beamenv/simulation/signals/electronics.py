"""The electronics between a controller and N blades, with a scenario's imperfections, as they go from step to step."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtri

from beamenv.plant.plant import Plant, normalised
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.signals.faults import Faults, SignalMemory, acquire, draw_faults, drive
from beamenv.simulation.signals.hysteresis import PLAYS, Hysteresis, prandtl_ishlinskii

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


class Electronics:
    """The electronics of N blades: their faults in this episode, and what they remember."""

    def __init__(self, plant: Plant, scenario: Scenario, count: int) -> None:
        m, p = plant.B.shape[1], len(plant.C)
        self._scenario = scenario
        self.hysteresis = _hysteresis(plant, scenario.drive.hysteresis)
        self.threshold = float(ndtri(scenario.acquisition.dropout)) if scenario.acquisition.dropout else None
        """A reading is lost where its standard normal is below."""
        self.faults = Faults(np.zeros(count, dtype=np.int64), np.ones((count, m)), np.ones((count, p)), np.zeros((count, p)))
        plays = np.zeros((count, m, PLAYS if self.hysteresis else 0))
        self.memory = SignalMemory(np.zeros((count, scenario.drive.delay[1] + 1, m)), plays, np.zeros((count, p)))

    def begin(self, rows: Rows, uniforms: Array) -> None:
        """Draw the faults of new episodes and forget the past."""
        _, m = self.faults.actuator_gain.shape
        _, p = self.faults.sensor_gain.shape
        self.faults = self.faults.replace(rows, draw_faults(self._scenario.failures, self._scenario.drive.delay, uniforms, m, p))
        self.memory = SignalMemory(*(part.copy() for part in self.memory))
        for part in self.memory:
            part[rows] = 0.0

    def first_reading(self, rows: Rows, output: Array, noise: Array) -> Array:
        """Readings (rows, p) at the start of episodes: none is lost."""
        readings, _ = acquire(self.faults.rows(rows), self.memory, output, noise, None)
        self.memory.readings[rows] = readings
        return np.asarray(readings)

    def drive(self, held: Array) -> Array:
        """Voltages (N, m) that act, from those held."""
        acting, self.memory = drive(self.faults, self.hysteresis, self.memory, held)
        return np.asarray(acting)

    def acquire(self, output: Array, disturbance: Array) -> Array:
        """Readings (N, p) from outputs (N, p) and [noise | lost | …] (N, c)."""
        p = output.shape[1]
        lost = None if self.threshold is None else disturbance[:, p : 2 * p] < self.threshold
        readings, self.memory = acquire(self.faults, self.memory, output, disturbance[:, :p], lost)
        return np.array(readings)

    def state_dict(self) -> dict[str, dict[str, Array]]:
        """Copies of what moves: the faults of the episodes under way, and what is remembered."""
        return {
            "faults": self.faults.state_dict(),
            "memory": {name: np.array(values) for name, values in self.memory._asdict().items()},
        }

    def load_state_dict(self, state: Mapping[str, Mapping[str, ArrayLike]]) -> None:
        """Go back to a ``state_dict`` of equally made electronics."""
        self.faults = Faults.from_state_dict(state["faults"])
        self.memory = SignalMemory(**{name: np.asarray(values).copy() for name, values in state["memory"].items()})


def _hysteresis(plant: Plant, loop: float) -> Hysteresis | None:
    lowest, highest = normalised(plant).voltage_limits
    return prandtl_ishlinskii(loop, float(lowest.min()), float(highest.max())) if loop else None
