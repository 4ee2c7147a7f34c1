"""What made an environment, as Gymnasium keeps it, made so that ``to_json`` works and the time limit is told."""

from __future__ import annotations

from collections.abc import Mapping, Set
from copy import copy
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
        return value.tolist()
    if isinstance(value, np.dtype) or (isinstance(value, type) and issubclass(value, np.generic)):
        return np.dtype(value).name
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, Mapping):
        return {plain(name): plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple, range, Set)):
        return [plain(each) for each in value]
    return value


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
        told.max_episode_steps = self._steps if limit is None else min(limit, self._steps)
        return told

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        if spec is not None:
            spec.kwargs = plain(spec.kwargs)
            limit = spec.kwargs.pop("max_episode_steps", None)  # told by the spec itself, also when a batch is made from it
            spec.max_episode_steps = limit if spec.max_episode_steps is None else spec.max_episode_steps
        self._spec = spec
