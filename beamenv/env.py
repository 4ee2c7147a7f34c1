"""The Gymnasium environment ``beamenv/RotatingBeam-v0``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import BladeConfig
from beamenv.plant import Plant
from beamenv.scenarios import Scenario
from beamenv.simulation import Blades
from beamenv.task import checked_action, information, reset_options, resolve_task

if TYPE_CHECKING:
    from beamenv.rendering import BladeRenderer

Array = NDArray[np.float64]


class RotatingBeamEnv(gymnasium.Env[Any, Any]):
    """PLACEHOLDER."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(
        self,
        preset: str = "thesis",
        speed: float | None = None,
        blade: BladeConfig | Mapping[str, Any] | None = None,
        design: BladeConfig | Mapping[str, Any] | str | None = None,
        scenario: Scenario | Mapping[str, Any] | str | None = None,
        duration: float = 0.5,
        physical_units: bool = False,
        render_mode: str | None = None,
    ) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode is {render_mode!r}, but must be None or one of {self.metadata['render_modes']}.")
        self.task = resolve_task(preset, speed, blade, design, scenario, duration, physical_units)
        self.render_mode = render_mode
        self.action_space = self.task.action_space()
        self.observation_space = self.task.observation_space()
        self._blade = Blades(self.plant, self.task.scenario, None, self.task.physical_units)
        self._action_shape = (self.plant.B.shape[1],)
        self._steps = self.task.steps
        self._elapsed = 0
        self._generators: list[np.random.Generator] | None = None
        self._renderer: BladeRenderer | None = None

    @property
    def plant(self) -> Plant:
        """The true plant, the one that moves."""
        return self.task.plant

    @property
    def design_plant(self) -> Plant:
        """The plant controllers are to be designed for."""
        return self.task.design_plant

    @property
    def state(self) -> Array:
        """(n,) the true state, hidden from an agent: in energy coordinates, ½ xᵀx in joules."""
        return self._blade.state

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin an episode; ``options`` may fix its "load" or give its "initial_state" (see the class)."""
        scenario, initial_state = reset_options(self.task, options, rows=1)
        super().reset(seed=seed)
        self._generators = [self.np_random]
        self._elapsed = 0
        motion = self._blade.begin(self._generators, scenario=scenario, initial_state=initial_state)
        if self._renderer is not None:
            self._renderer.begin(self.state)
        return motion.observation, information(motion)

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Hold the voltages over one control interval."""
        if self._generators is None:
            raise gymnasium.error.ResetNeeded("Call reset before step.")
        motion = self._blade.step(checked_action(action, self._action_shape), self._generators)
        self._elapsed += 1
        return motion.observation, float(motion.reward), bool(motion.failed), self._elapsed >= self._steps, information(motion)
