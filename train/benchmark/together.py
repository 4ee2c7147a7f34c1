"""Several controllers on the same episodes with the load case and without it, in one batch of blades: many are stepped faster."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv, VectorWrapper
from numpy.typing import NDArray

from baselines import Controller, Episodes
from baselines.evaluation.conditions import conditions
from baselines.evaluation.episodes import NO_LOAD, of_series, recorded
from baselines.evaluation.fit import check_fit

Array = NDArray[np.float64]
Envs = VectorEnv[Any, Any, Any]

TIP = 2
"""Place of the tip's displacements among what is ``recorded``."""


class SideBySide:
    """Controllers that act on equal parts of a batch, one after the other; all observe the same."""

    def __init__(self, controllers: Sequence[Controller]) -> None:
        self.controllers, self.observes = controllers, observes(controllers[0])

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = True
    ) -> tuple[Array, tuple[Any, ...]]:
        """Each is shown its part; the memory is theirs."""
        count = len(self.controllers)
        seen, begins, memories = np.split(observation, count), np.split(episode_start, count), state or (None,) * count
        decided = [
            each.predict(part, state=memory, episode_start=begin, deterministic=deterministic)
            for each, part, memory, begin in zip(self.controllers, seen, memories, begins, strict=True)
        ]
        return np.concatenate([action for action, _ in decided]), tuple(memory for _, memory in decided)


class WithAndWithoutLoad(VectorWrapper[Any, Any, Any]):
    """Every second of equal parts of a batch begins its episodes without a load case."""

    def __init__(self, envs: Envs, size: int) -> None:
        super().__init__(envs)
        self._without = np.arange(envs.num_envs) // size % 2 == 1

    def reset(self, *, seed: Any = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        """All begin, and then those parts anew."""
        self.env.reset(seed=seed, options=options)
        return self.env.reset(seed=seed, options={**NO_LOAD, "reset_mask": self._without})


def observes(controller: Any) -> str:
    """What it is shown."""
    return str(getattr(controller, "observes", "observation"))


def roll_out_together(controllers: Sequence[Controller], envs: Envs, seeds: Sequence[int]) -> list[Episodes]:
    """As ``baselines.roll_out`` of each, to rounding, in a batch that has two blades for each of them and each seed.

    Raises ValueError as it does, and whatever any of the controllers does.
    """
    for each in controllers:
        check_fit(each, envs)
    parts = 2 * len(controllers)
    series = recorded(SideBySide(controllers), WithAndWithoutLoad(envs, len(seeds)), tuple(seeds) * parts)
    own, under = [np.split(each, parts, axis=1) for each in series], conditions(envs, len(seeds))
    found = []
    for k in range(0, parts, 2):
        loaded, tremor = [each[k] for each in own], own[TIP][k + 1]
        found.append(of_series(tuple(seeds), (*loaded, tremor), envs, under))
    return found
