"""What made an environment, as Gymnasium keeps it, made so that ``to_json`` works and the time limit is told."""

from __future__ import annotations

from collections.abc import Mapping, Set
from copy import copy
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium.envs.registration import EnvSpec

from beamenv.plant.model_files import plant_table
from beamenv.plant.plant import Plant


def plain(value: Any) -> Any:
    """The value in types that JSON knows: arrays, ranges and tuples as lists, NumPy's numbers, paths and modes as what they say.

    Plants are tables of all their fields. Other dataclasses are left to ``EnvSpec.to_json``, which knows them.
    """
    if isinstance(value, Plant):
        return plant_table(value)
    if isinstance(value, Enum):
        return plain(value.value)
    if isinstance(value, (np.generic, np.ndarray)):
        return (value.astype(np.float64) if value.dtype == np.longdouble else value).tolist()
    if isinstance(value, np.dtype) or (isinstance(value, type) and issubclass(value, np.generic)):
        return np.dtype(value).name
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, Mapping):
        return {plain(name): plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple, range, Set)):
        return [plain(each) for each in value]
    return value


class Unwritable(EnvSpec):
    """A specification with a function among its arguments, which is told from the others when it is to be written."""

    def to_json(self) -> str:
        """``ValueError`` that names the function."""
        path = _function_in(self.kwargs)
        raise ValueError(f"{path} is a function, which no JSON can hold: give a series of numbers or a CSV file to write the spec.")


def _function_in(value: Any, path: str = "") -> str | None:
    """The path of the first function within plain arguments; None where there is none."""
    if callable(value):
        return path
    if isinstance(value, Mapping):
        parts = [(f"{path}.{name}" if path else str(name), each) for name, each in value.items()]
    elif isinstance(value, list):
        parts = [(f"{path}[{k}]", each) for k, each in enumerate(value)]
    elif is_dataclass(value) and not isinstance(value, type):
        parts = [(f"{path}.{each.name}", getattr(value, each.name)) for each in fields(value)]
    else:
        return None
    return next((found for name, each in parts if (found := _function_in(plain(each), name)) is not None), None)


class Specified:
    """An environment whose ``spec`` tells how many steps an episode has at most, and can be written as JSON."""

    _steps: int
    _spec: EnvSpec | None = None

    @property
    def spec(self) -> EnvSpec | None:
        """What made this environment; ``max_episode_steps`` is what `duration` comes to, unless it is told to be shorter."""
        if self._spec is None:
            return None
        told, limit = copy(self._spec), self._spec.max_episode_steps
        if _function_in(told.kwargs) is not None:
            told.__class__ = Unwritable
        told.max_episode_steps = self._steps if limit is None else min(limit, self._steps)
        return told

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        if spec is not None:
            spec.kwargs = plain(spec.kwargs)
            limit = spec.kwargs.pop("max_episode_steps", None)  # told by the spec itself, also when a batch is made from it
            spec.max_episode_steps = limit if spec.max_episode_steps is None else spec.max_episode_steps
        self._spec = spec
