"""The electronics between a controller and N blades, with a scenario's imperfections, as they go from step to step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtri

from beamenv.plant.plant import Plant, normalised
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.signals.faults import DRAWS, Faults, Onsets, SignalMemory, acquire, draw_faults, draw_onsets, drive
from beamenv.simulation.signals.hysteresis import PLAYS, Hysteresis, prandtl_ishlinskii

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


class Electronics:
    """The electronics of N blades: their faults in this episode, and what they remember."""

    def __init__(self, plant: Plant, scenario: Scenario, count: int) -> None:
        m, p = plant.B.shape[1], len(plant.C)
        self._scenario, self._interval = scenario, plant.scenario_interval
        self.hysteresis = hysteresis_of(plant, scenario.drive.hysteresis)
        self.threshold = float(ndtri(scenario.acquisition.dropout)) if scenario.acquisition.dropout else None
        """A reading is lost where its standard normal is below."""
        self.faults = Faults(np.zeros(count, dtype=np.int64), np.ones((count, m)), np.ones((count, p)), np.zeros((count, p)))
        """Those at work now."""
        self._in_episode = self.faults
        self._elapsed = np.zeros(count, dtype=np.int64)
        self._onsets = Onsets(*np.zeros((2, count), dtype=np.int64)) if scenario.failures.drawn_instants else None
        self.changing = self._onsets is not None
        """Whether faults set in within episodes."""
        plays = np.zeros((count, m, PLAYS if self.hysteresis else 0))
        self.memory = SignalMemory(np.zeros((count, scenario.drive.delay[1] + 1, m)), plays, np.zeros((count, p)))

    def begin(self, rows: Rows, uniforms: Array) -> None:
        """Draw the faults of new episodes and forget the past."""
        _, m = self.faults.actuator_gain.shape
        _, p = self.faults.sensor_gain.shape
        failures, delay = self._scenario.failures, self._scenario.drive.delay
        self._in_episode = self._in_episode.replace(rows, draw_faults(failures, delay, uniforms, m, p))
        self._elapsed[rows] = 0
        if self._onsets is not None:
            begun = draw_onsets(failures, self._interval, uniforms[:, DRAWS:])
            self._onsets.actuators[rows], self._onsets.sensors[rows] = begun.actuators, begun.sensors
        self._set_in()
        self.memory = SignalMemory(*(part.copy() for part in self.memory))
        for part in self.memory:
            part[rows] = 0.0

    def _set_in(self) -> None:
        self.faults = self._in_episode if self._onsets is None else self._onsets.set_in(self._in_episode, self._elapsed)

    def elapse(self) -> None:
        """One control interval later: what breaks at this instant is broken."""
        self._elapsed += 1
        if self._onsets is not None and self._onsets.begins(self._elapsed):
            self._set_in()

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

    def told(self) -> Array:
        """(N, 1 + m + 2 p): delay, gains of actuators, gains of sensors, biases of sensors: what is wrong now."""
        faults = self.faults
        return np.hstack([faults.delay[:, None], faults.actuator_gain, faults.sensor_gain, faults.sensor_bias])

    def state_dict(self) -> dict[str, dict[str, Any]]:
        """Copies of what moves: the faults of the episodes under way, when they set in, and what is remembered."""
        moving: dict[str, dict[str, Any]] = {
            "faults": self._in_episode.state_dict(),
            "memory": {name: np.array(values) for name, values in self.memory._asdict().items()},
        }
        if self._onsets is not None:
            when = {"elapsed": self._elapsed, "actuators": self._onsets.actuators, "sensors": self._onsets.sensors}
            moving["onsets"] = {name: values.copy() for name, values in when.items()}
        return moving

    def load_state_dict(self, state: Mapping[str, Mapping[str, ArrayLike]]) -> None:
        """Go back to a ``state_dict`` of equally made electronics."""
        self._in_episode = Faults.from_state_dict(state["faults"])
        if self._onsets is not None:
            self._elapsed, *both = (np.asarray(state["onsets"][name]).copy() for name in ("elapsed", "actuators", "sensors"))
            self._onsets = Onsets(*both)
        self._set_in()
        self.memory = SignalMemory(**{name: np.asarray(values).copy() for name, values in state["memory"].items()})


def hysteresis_of(plant: Plant, loop: float) -> Hysteresis | None:
    """That of a loop, for voltages normalised to the drive of a plant; None without one."""
    lowest, highest = normalised(plant).voltage_limits
    return prandtl_ishlinskii(loop, float(lowest.min()), float(highest.max())) if loop else None
