"""What a controller is to whoever runs one: anything with SB3's ``predict``, or a plain function of the observations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal, Protocol, TypeAlias, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import clause, shown

Array = NDArray[np.float64]
Observes = Literal["observation", "state", "observation and speed", "observation and truth"]
"""What ``predict`` wants: the sensors' readings, the true state, or the readings (p,) with the rotor speed in rad/s behind them, or
with the episode's truth, ``env.unwrapped.episode_truth``."""

LEAST_TIER: Mapping[str, int] = MappingProxyType(
    {"observation": 0, "observation and speed": 2, "state": 3, "observation and truth": 3}
)
"""The least tier of information (``beamenv.knowledge``) at which each of these may be seen."""


@runtime_checkable
class Controller(Protocol):
    """Any object with Stable-Baselines3's ``predict``: controllers of this package, and SB3's own models."""

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = True
    ) -> tuple[Any, Any]:
        """Action and next memory for one observation or a batch (leading axis); ``state=None`` starts afresh."""
        ...


ControllerArgument: TypeAlias = "Controller | Callable[[Any], Any]"
"""A controller, or a function from observations (N, p) to actions (N, m)."""


@dataclass(frozen=True, slots=True, eq=False)
class FunctionController:
    """A function of the observations alone, called with those of all blades at once: (N, p) to (N, m)."""

    function: Callable[[Any], Any]

    @property
    def name(self) -> str:
        """The function's own."""
        name = getattr(self.function, "__name__", type(self.function).__name__)
        return "function" if name == "<lambda>" else str(name)

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = True
    ) -> tuple[Any, None]:
        """Action and no memory. Raises ValueError unless the function gives as many rows of voltages as it is given readings."""
        given = self.function(observation)
        try:
            action = np.asarray(given)
        except (TypeError, ValueError, RuntimeError) as error:  # torch raises the last of a tensor that wants a gradient
            raise ValueError(f"controller = {self.name} gives what is no array: {clause(error)}.") from None
        if np.shape(observation)[:-1] == (1,) and action.ndim == 1:  # of a blade alone, a row says enough
            action = action[None]
        if action.ndim != np.ndim(observation) or action.shape[:-1] != np.shape(observation)[:-1]:
            raise ValueError(
                f"controller = {self.name} gives actions of shape {action.shape} for observations of shape "
                f"{np.shape(observation)}, but must give one row of voltages for each row of readings."
            )
        return action, None


def as_controller(controller: ControllerArgument) -> Controller:
    """The controller itself, or a plain function as one; ValueError for anything else."""
    if isinstance(controller, type) or not callable(getattr(controller, "predict", controller)):
        raise ValueError(
            f"controller = {shown(controller)} is not allowed: it must be an object with Stable-Baselines3's predict, or a "
            "function of the observations (N, p) that returns actions (N, m)."
        )
    return controller if hasattr(controller, "predict") else FunctionController(controller)


def name_of(controller: object) -> str:
    """What tables and figures call a controller: its ``name``, or else that of its kind."""
    return str(getattr(controller, "name", type(controller).__name__))
