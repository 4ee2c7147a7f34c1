"""Wrappers that show an agent the recent past: one reading cannot tell the state of the blade."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from gymnasium.utils import RecordConstructorArgs
from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from beamenv.configuration import Count, checked
from beamenv.configuration.memory import check_room
from beamenv.envs.states import check_state
from beamenv.envs.within import task_within
from beamenv.plant.plant import Plant, drive_limit

Array = NDArray[np.floating[Any]]

LONGEST = 10_000
"""Instants: five seconds of the default interval, and some hundred kilobytes a blade."""

INSTANT = 20
"""Bytes that a number of a history takes for each instant shown: four in the window, four times that in what it moves along."""


class RollingHistory:
    """The last ``length`` instants of a batch of blades: the one definition of how a history is laid out.

    A window (N, length · (p + m)) holds the oldest instant first. For each instant it has the p sensor readings and then
    the m voltages that were held in the interval before it, both normalised; zeros where the episode had not begun.
    """

    def __init__(self, count: int, length: int, readings: int, voltages: int, dtype: Any = np.float32) -> None:
        self.length, self.width = length, readings + voltages
        self._readings = readings
        self._buffer = np.zeros((count, 4 * length, self.width), dtype=dtype)
        self._end = length

    def begin(self, readings: ArrayLike, rows: Any = slice(None)) -> None:
        """Forget the past of ``rows``; ``readings`` (len(rows), p) are all there is."""
        self._buffer[rows, self._end - self.length : self._end] = 0.0
        self._buffer[rows, self._end - 1, : self._readings] = readings

    def append(self, readings: ArrayLike, voltages: ArrayLike) -> None:
        """One more instant: ``readings`` (N, p) after ``voltages`` (N, m), both normalised."""
        if self._end == self._buffer.shape[1]:
            kept = self.length - 1
            self._buffer[:, :kept] = self._buffer[:, self._end - kept : self._end]
            self._end = kept
        self._end += 1
        self.replace_last(slice(None), readings, voltages)

    def replace_last(self, rows: Any, readings: ArrayLike, voltages: ArrayLike) -> None:
        """Put another last instant in the place of that of ``rows``."""
        self._buffer[rows, self._end - 1, : self._readings] = readings
        self._buffer[rows, self._end - 1, self._readings :] = voltages

    def window(self, rows: Any = slice(None)) -> Array:
        """The histories (len(rows), length · (p + m)), a copy."""
        kept = np.array(self._buffer[rows, self._end - self.length : self._end], order="C")
        return kept.reshape(len(kept), -1)

    def state_dict(self) -> dict[str, Array]:
        """A copy of the windows."""
        return {"window": self.window()}

    def load_state_dict(self, state: Mapping[str, ArrayLike]) -> None:
        """Go back to a ``state_dict`` of an equally made history."""
        self._end = self.length
        self._buffer[:, : self.length] = np.asarray(state["window"]).reshape((-1, self.length, self.width))


class SensorHistory(gymnasium.Wrapper[Any, Any, Any, Any], RecordConstructorArgs):
    """Shows the last ``length`` readings and voltages instead of the last reading alone; see ``RollingHistory`` for their order.

    - `env`: a `RotatingBeamEnv` with normalised units, under no wrapper that changes its readings.
    - `length`: instants shown, default 12: at 0.5 ms they cover 6 ms, a sixth of the slowest mode's period and
      two of the fastest retained one's.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], length: int = 12) -> None:
        RecordConstructorArgs.__init__(self, length=checked("length", length, Count(1, LONGEST)))
        plant, length = normalised_plant(env, length, of_batch=False)
        gymnasium.Wrapper.__init__(self, env)
        self._drive = drive_limit(plant)
        self._history = RollingHistory(1, length, len(plant.C), len(self._drive))
        self.observation_space = _space(self._history)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin an episode with an empty past."""
        reading, info = self.env.reset(seed=seed, options=options)
        self._history.begin(reading)
        return self._history.window()[0], info

    def step(self, action: Array) -> tuple[Array, Any, bool, bool, dict[str, Any]]:
        """Step and show the past."""
        reading, reward, terminated, truncated, info = self.env.step(action)
        self._history.append(reading, info["volts"] / self._drive)
        return self._history.window()[0], reward, terminated, truncated, info


class VectorSensorHistory(VectorWrapper):  # in Gymnasium 1.2 it takes no type parameters
    """``SensorHistory`` for the batched environment, in each of its autoreset modes.

    - `env`: a `RotatingBeamVectorEnv` with normalised units.
    - `length`: instants shown, default 12.

    With SAME_STEP `info["final_obs"]` holds the histories at the end of the finished episodes.
    """

    def __init__(self, env: VectorEnv[Any, Any, NDArray[Any]], length: int = 12) -> None:
        plant, length = normalised_plant(env, length, of_batch=True)
        super().__init__(env)
        self._drive = drive_limit(plant)
        self._history = RollingHistory(env.num_envs, length, len(plant.C), len(self._drive))
        self.single_observation_space = _space(self._history)
        self.observation_space = batch_space(self.single_observation_space, env.num_envs)
        self._mode = self.autoreset_mode
        self._over = np.zeros(env.num_envs, dtype=np.bool_)

    @property
    def autoreset_mode(self) -> AutoresetMode:
        """The batch's: Gymnasium tells it in ``metadata``, and TorchRL asks for it by this name."""
        return self.env.metadata["autoreset_mode"]

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Begin every episode with an empty past, or those of a "reset_mask" alone."""
        readings, info = self.env.reset(seed=seed, options=options)
        mask = (options or {}).get("reset_mask")
        rows = np.arange(self.num_envs) if mask is None else np.flatnonzero(mask)
        self._history.begin(readings[rows], rows)
        self._over[rows] = False
        return self._history.window(), info

    def step(self, actions: Array) -> tuple[Array, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Step and show the past of each blade."""
        readings, reward, terminated, truncated, info = self.env.step(actions)
        self._history.append(readings, info["volts"] / self._drive)
        if self._mode is AutoresetMode.SAME_STEP:
            self._finish(readings, info)
        elif self._mode is AutoresetMode.NEXT_STEP:
            if self._over.any():
                rows = np.flatnonzero(self._over)
                self._history.begin(readings[rows], rows)
            self._over = terminated | truncated
        return self._history.window(), reward, terminated, truncated, info

    def state_dict(self) -> dict[str, Any]:
        """The windows; the blades' own state is ``unwrapped.state_dict()``."""
        return {**self._history.state_dict(), "over": self._over.copy()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of an equally made wrapper; ``ValueError`` of another."""
        check_state(state, self.state_dict())
        self._history.load_state_dict(state)
        self._over = np.asarray(state["over"]).copy()

    def _finish(self, readings: Array, info: dict[str, Any]) -> None:
        """Put the whole histories of finished episodes into ``info``, and begin those of the next ones."""
        if "final_obs" not in info:
            return
        rows = np.flatnonzero(info["_final_obs"])
        self._history.replace_last(rows, np.stack(info["final_obs"][rows]), info["final_info"]["volts"][rows] / self._drive)
        for row, window in zip(rows.tolist(), self._history.window(rows), strict=True):
            info["final_obs"][row] = window
        self._history.begin(readings[rows], rows)


def _space(history: RollingHistory) -> Box:
    return Box(-1.0, 1.0, (history.length * history.width,), np.float32)


def normalised_plant(env: Any, length: Any, of_batch: bool, of_tensors: bool = False) -> tuple[Plant, int]:
    """The plant of the environment within, and the length as an integer; ValueError unless both will do."""
    length = checked("length", length, Count(1, LONGEST))
    task = task_within(env, of_batch, of_tensors=of_tensors)
    plant, blades = task.plant, env.num_envs if of_batch else 1
    check_room("length", length, INSTANT * blades * (len(plant.C) + plant.B.shape[1]), "instants")
    if task.physical_units:
        raise ValueError("env has physical_units=True, but a history is made of normalised readings and voltages.")
    return plant, length
