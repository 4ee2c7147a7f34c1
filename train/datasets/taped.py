"""Episodes of a batch kept whole: what was seen, done and earned, to the last bit what the environment was given and gave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv, VectorWrapper
from numpy.typing import NDArray

from baselines import Controller
from baselines.evaluation.loop import beside_observation, instants

SHOWN = {"observation and speed": "rotor_speed", "observation and truth": "episode_truth", "state": "design_state"}
"""Name among an episode's infos of what a controller sees besides the readings, or instead of them, by what it ``observes``."""


@dataclass(frozen=True, slots=True, eq=False)
class Episode:
    """T control intervals of one blade, in the units of its environment."""

    seed: int
    observations: NDArray[Any]
    """(T + 1, p): the readings at the reset and after each interval."""
    actions: NDArray[Any]
    """(T, m): what was asked for, within the action space."""
    rewards: NDArray[np.float64]
    """(T,)."""
    terminations: NDArray[np.bool_]
    """(T,): whether the blade failed."""
    truncations: NDArray[np.bool_]
    """(T,): whether its time was over."""
    infos: dict[str, NDArray[Any]]
    """(T + 1, …) each: what ``info`` tells of motion and cost, and what the controller was shown besides the readings."""

    @property
    def cost(self) -> float:
        """J, J s: over the intervals that were run."""
        return float(self.infos["cost_increment"].sum())

    @property
    def failed(self) -> bool:
        """Whether the blade was terminated before its time was over."""
        return bool(self.terminations[-1])


class Tape(VectorWrapper[Any, Any, Any]):
    """A batch that keeps what it was last given and what it gave; actions reach it as the action space has them."""

    def step(self, actions: Any) -> Any:
        """As the batch does, of actions within the limits and in the space's numbers: what is kept is what acted."""
        space: Any = self.action_space
        self.given = np.clip(np.asarray(actions, dtype=space.dtype), space.low, space.high)
        result = self.env.step(self.given)
        self.earned, self.terminated, self.truncated = result[1:4]
        return result


def episodes_of(controller: Controller, envs: VectorEnv[Any, Any, Any], seeds: Sequence[int]) -> list[Episode]:
    """One episode for each seed and blade of a batch whose episodes begin a step after they have ended (``NEXT_STEP``)."""
    tape, observes = Tape(envs), getattr(controller, "observes", "observation")
    seen, infos, steps = [], [], []
    for instant in instants(controller, tape, seeds):
        beside = beside_observation(observes, tape)
        seen.append(instant.observation)
        infos.append({**instant.info, **({} if beside is None else {SHOWN[observes]: beside})})
        if len(seen) > 1:
            steps.append((tape.given, tape.earned, tape.terminated, tape.truncated))
    return _each(seeds, seen, infos, steps)


def _each(seeds: Sequence[int], seen: list[Any], infos: list[dict[str, Any]], steps: list[tuple[Any, ...]]) -> list[Episode]:
    """The records of a batch, instant by instant, as episodes, each as long as it was."""
    observations = np.stack(seen)
    told = {name: np.stack([each[name] for each in infos]) for name in infos[0]}
    actions, rewards, terminations, truncations = (np.stack(each) for each in zip(*steps, strict=True))
    lengths = np.argmax(terminations | truncations, axis=0) + 1
    return [
        Episode(
            seed,
            observations[: length + 1, row],
            actions[:length, row],
            rewards[:length, row],
            terminations[:length, row],
            truncations[:length, row],
            {name: values[: length + 1, row] for name, values in told.items() if values[0, row].size},
        )
        for row, (seed, length) in enumerate(zip(seeds, lengths.tolist(), strict=True))
    ]
