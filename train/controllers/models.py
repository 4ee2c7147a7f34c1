"""Models of Stable-Baselines3: loading one from a file, and showing it what it was trained to see."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from zipfile import is_zipfile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines import Controller
from baselines.design.controller import name_of
from baselines.design.predicting import observed
from beamenv.configuration import Refused
from beamenv.plant.plant import Plant, normalised
from train.shared.files import as_path

Array = NDArray[np.floating[Any]]

ALGORITHMS = {
    "stable_baselines3": ("PPO", "A2C", "SAC", "TD3", "DDPG"),
    "sb3_contrib": ("TQC", "TRPO", "CrossQ", "ARS", "RecurrentPPO"),
}
"""Those with continuous actions."""

UNTRUSTED = (
    "a model file can run any code when it is loaded: load only files you have made yourself or whose maker you trust, "
    "and say so with --trust."
)


def load_model(path: Path) -> Any:
    """The model in a file, of whichever algorithm takes it; ``ValueError`` if none does. Loading may run code in the file."""
    path = as_path("model", path)
    if not (path.is_file() and is_zipfile(path)):
        raise ValueError(f"model {path.name!r} must be a .zip file saved by Stable-Baselines3, but is none, or is not there.")
    tried = []
    for package, names in ALGORITHMS.items():
        for name in names if find_spec(package) else ():
            try:
                return getattr(import_module(package), name).load(path, device="cpu")
            except Exception:  # noqa: BLE001, PERF203 - each algorithm fails in a way of its own on the files of another
                tried.append(name)
    raise ValueError(f"model {path.name!r} could not be loaded by any of {', '.join(tried)}.")


def fitted(controller: Any, plant: Plant) -> Controller:
    """The controller itself, or, where it tells its spaces, a model shown readings or their history as these spaces want it.

    Raises ValueError for spaces that do not fit the plant's p sensors and m voltages.
    """
    seen, acts = getattr(controller, "observation_space", None), getattr(controller, "action_space", None)
    if seen is None or acts is None:
        return controller
    readings, voltages = len(plant.C), plant.B.shape[1]
    name = name_of(controller)
    if getattr(acts, "shape", None) != (voltages,) or not _bounded_by_one(acts):
        raise ValueError(f"{name} acts in {acts}, but must in a Box from -1 to 1 of shape ({voltages},).")
    size = seen.shape[0] if getattr(seen, "shape", None) and len(seen.shape) == 1 else 0
    length = 0 if size == readings else size // (readings + voltages)
    if size != (length * (readings + voltages) or readings) or not _holds_readings(seen):
        raise ValueError(
            f"{name} observes {seen}, but must observe a Box that holds -1 to 1 of shape ({readings},), or of a multiple of "
            f"{readings + voltages} as SensorHistory gives it."
        )
    lowest, highest = normalised(plant).voltage_limits.astype(np.float32)
    return ShownHistory(controller, name, length, lowest, highest) if length else controller


def _bounded_by_one(space: Any) -> bool:
    return bool(np.all(np.asarray(space.low) == -1.0) and np.all(np.asarray(space.high) == 1.0)) if hasattr(space, "low") else False


def _holds_readings(space: Any) -> bool:
    return bool(np.all(np.asarray(space.low) <= -1.0) and np.all(np.asarray(space.high) >= 1.0)) if hasattr(space, "low") else False


@dataclass(frozen=True, slots=True, eq=False)
class ShownHistory:
    """A model that sees ``SensorHistory``'s windows, given plain readings: it keeps the window in its memory.

    The memory is (window (N, length · (p + m)), the last voltages (N, m), the model's own memory). The voltages are those asked
    for, as the drive limits let them through.
    """

    model: Any
    name: str
    length: int
    lowest: Array
    highest: Array
    """(m,) drive limits in units of the larger one."""

    def predict(
        self,
        observation: ArrayLike,
        state: tuple[Array, Array, Any] | None = None,
        episode_start: ArrayLike | None = None,
        deterministic: bool = True,
    ) -> tuple[Array, tuple[Array, Array, Any]]:
        """Action (N, m) on readings (N, p), and the next memory."""
        readings = observed(observation, self.name).astype(np.float32)
        if readings.ndim != 2:
            raise Refused("observation", observation, "rows of readings (N, p)")
        instant = readings.shape[1] + len(self.lowest)
        if state is None:
            state = np.zeros((len(readings), self.length * instant), np.float32), np.zeros((len(readings), len(self.lowest))), None
        window, voltages, own = state
        if episode_start is not None:
            begins = np.reshape(episode_start, (-1, 1)).astype(bool)
            window, voltages = np.where(begins, np.float32(0.0), window), np.where(begins, 0.0, voltages)
        window = np.hstack([window[:, instant:], readings, voltages]).astype(np.float32)
        action, own = self.model.predict(window, state=own, episode_start=episode_start, deterministic=deterministic)
        return action, (window, np.clip(action, self.lowest, self.highest), own)
