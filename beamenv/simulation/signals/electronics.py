"""The electronics between a controller and N blades, with a scenario's imperfections, as they go from step to step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.special import ndtri

from beamenv.arrays import REFERENCE, Arrays, Those, copied, namespace
from beamenv.plant.plant import Plant, normalised
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.signals.faults import DRAWS, Faults, Onsets, SignalMemory, acquire, draw_faults, draw_onsets, drive
from beamenv.simulation.signals.hysteresis import PLAYS, Hysteresis, prandtl_ishlinskii


class Electronics:
    """The electronics of N blades: their faults in this episode, and what they remember."""

    def __init__(self, plant: Plant, scenario: Scenario, count: int, arrays: Arrays = REFERENCE) -> None:
        m, p, zeros = plant.B.shape[1], len(plant.C), arrays.zeros
        self._scenario, self._interval, self._arrays = scenario, plant.scenario_interval, arrays
        hysteresis = hysteresis_of(plant, scenario.drive.hysteresis)
        self.hysteresis = None if hysteresis is None else hysteresis.convert(arrays.floats)
        self.threshold = float(ndtri(scenario.acquisition.dropout)) if scenario.acquisition.dropout else None
        """A reading is lost where its standard normal is below."""
        none = arrays.exact(np.zeros(count, dtype=np.int64))
        self.faults = Faults(none, 1.0 + zeros(count, m), 1.0 + zeros(count, p), zeros(count, p))
        """Those at work now."""
        self._in_episode = self.faults
        self._elapsed = none
        self._onsets = Onsets(none, none) if scenario.failures.drawn_instants else None
        self.changing = self._onsets is not None
        """Whether faults set in within episodes."""
        plays = zeros(count, m, PLAYS if self.hysteresis else 0)
        self.memory = SignalMemory(zeros(count, scenario.drive.delay[1] + 1, m), plays, zeros(count, p))

    def begin(self, those: Those, uniforms: Any) -> None:
        """Draw the faults of new episodes and forget the past."""
        m, p = self.faults.actuator_gain.shape[1], self.faults.sensor_gain.shape[1]
        failures, floats = self._scenario.failures, self._arrays.floats
        drawn = draw_faults(failures, self._scenario.drive.delay, uniforms, m, p)
        self._in_episode = self._in_episode.replace(those, drawn.convert(lambda part: part if is_whole(part) else floats(part)))
        self._elapsed = those.put(self._elapsed, 0 * drawn.delay)
        if self._onsets is not None:
            self._onsets = self._onsets.replace(those, draw_onsets(failures, self._interval, uniforms[:, DRAWS:]))
        self._set_in()
        self.memory = SignalMemory(*(those.put(part, namespace(part).zeros_like(those.take(part))) for part in self.memory))

    def _set_in(self) -> None:
        self.faults = self._in_episode if self._onsets is None else self._onsets.set_in(self._in_episode, self._elapsed)

    def elapse(self) -> None:
        """One control interval later: what breaks at this instant is broken."""
        self._elapsed = self._elapsed + 1
        if self._onsets is not None and (not self._arrays.looks or self._onsets.begins(self._elapsed)):
            self._set_in()

    def first_reading(self, those: Those, output: Any, noise: Any) -> Any:
        """Readings (k, p) at the start of episodes: none is lost."""
        readings, _ = acquire(self.faults.of(those), self.memory, output, noise, None)
        self.memory = self.memory._replace(readings=those.put(self.memory.readings, readings))
        return readings

    def drive(self, held: Any) -> Any:
        """Voltages (N, m) that act, from those held."""
        acting, self.memory = drive(self.faults, self.hysteresis, self.memory, held)
        return acting

    def acquire(self, output: Any, disturbance: Any) -> Any:
        """Readings (N, p) from outputs (N, p) and [noise | lost | …] (N, c)."""
        p = output.shape[1]
        lost = None if self.threshold is None else disturbance[:, p : 2 * p] < self.threshold
        readings, self.memory = acquire(self.faults, self.memory, output, disturbance[:, :p], lost)
        return np.array(readings) if self._arrays.of_numpy else readings

    def told(self) -> Any:
        """(N, 1 + m + 2 p): delay, gains of actuators, gains of sensors, biases of sensors: what is wrong now."""
        faults = self.faults
        return namespace(faults.delay).hstack([faults.delay[:, None], faults.actuator_gain, faults.sensor_gain, faults.sensor_bias])

    def detach(self) -> None:
        """Cut what is remembered from the graph that it came of."""
        self.memory = SignalMemory(*(part.detach() for part in self.memory))

    def state_dict(self) -> dict[str, dict[str, Any]]:
        """Copies of what moves: the faults of the episodes under way, when they set in, and what is remembered."""
        moving: dict[str, dict[str, Any]] = {
            "faults": self._in_episode.state_dict(),
            "memory": {name: copied(values) for name, values in self.memory._asdict().items()},
        }
        if self._onsets is not None:
            when = {"elapsed": self._elapsed, "actuators": self._onsets.actuators, "sensors": self._onsets.sensors}
            moving["onsets"] = {name: copied(values) for name, values in when.items()}
        return moving

    def load_state_dict(self, state: Mapping[str, Mapping[str, Any]]) -> None:
        """Go back to a ``state_dict`` of equally made electronics."""
        self._in_episode = Faults.from_state_dict(state["faults"])
        if self._onsets is not None:
            self._elapsed, *both = (copied(state["onsets"][name]) for name in ("elapsed", "actuators", "sensors"))
            self._onsets = Onsets(*both)
        self._set_in()
        self.memory = SignalMemory(**{name: copied(values) for name, values in state["memory"].items()})


def is_whole(values: Any) -> bool:
    """Whether an array is one of whole numbers."""
    return values.dtype.kind in "iu" if isinstance(values, np.ndarray) else not values.is_floating_point()


def hysteresis_of(plant: Plant, loop: float) -> Hysteresis | None:
    """That of a loop, for voltages normalised to the drive of a plant; None without one."""
    lowest, highest = normalised(plant).voltage_limits
    return prandtl_ishlinskii(loop, float(lowest.min()), float(highest.max())) if loop else None
