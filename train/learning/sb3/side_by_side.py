"""Several batches of blades, each in a scenario of its own, as one ``VecEnv``: for an agent that is to manage them all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from beamenv.envs.stable_baselines import options_of_each
from train.learning.sb3.vec_env import TrainingVecEnv

Array = NDArray[Any]


class SideBySide(VecEnv):
    """Batches one after the other. After what the actor sees, an observation has the state and which batch it is from.

    States of plants of different order are padded by zeros, displacements, velocities and the electronics' states apart: a mode
    keeps its place.
    """

    def __init__(self, batches: Sequence[TrainingVecEnv]) -> None:
        self.batches = list(batches)
        first = self.batches[0]
        self.seen, self.held = first.seen, first.held
        self._told = int(np.prod(first.observation_space.shape or ())) > self.seen
        """Whether observations have the state."""
        plants = [batch.blades.plant for batch in self.batches if self._told]
        self._half = max((plant.blade_states // 2 for plant in plants), default=0)
        electronic = max((len(plant.A) - 2 * (plant.blade_states // 2) for plant in plants), default=0)
        self._last = self.seen + 2 * self._half + electronic
        width = self._last + len(self.batches)
        count = sum(batch.num_envs for batch in self.batches)
        self._width = width
        super().__init__(count, Box(-np.inf, np.inf, (width,), np.float32), first.action_space)
        self._bounds = np.cumsum([batch.num_envs for batch in self.batches])[:-1]
        self._unfinished: list[dict[str, Any]] = [{} for _ in range(count)]

    @property
    def relative_cost(self) -> float:
        """Cost of the last step relative to no control, the mean over the batches."""
        return float(np.mean([batch.relative_cost for batch in self.batches]))

    def reset(self) -> Array:
        """Begin episodes in every batch."""
        observations = np.concatenate([self._widened(k, batch.reset()) for k, batch in enumerate(self.batches)])
        self.reset_infos = [info for batch in self.batches for info in batch.reset_infos]
        return observations

    def set_options(self, options: list[dict[str, Any]] | dict[str, Any] | None = None) -> None:
        """Options of the next reset: one dictionary for all blades, or a list of one for each."""
        each = options_of_each(options, self.num_envs)
        for batch, first in zip(self.batches, (0, *self._bounds.tolist()), strict=True):
            batch.set_options(each[first : first + batch.num_envs])

    def state_dict(self) -> dict[str, Any]:
        """Where the episodes are, batch by batch."""
        return {"batches": [batch.state_dict() for batch in self.batches]}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to the ``state_dict`` of equally made batches."""
        for batch, own in zip(self.batches, state["batches"], strict=True):
            batch.load_state_dict(own)

    def _widened(self, index: int, observations: Array) -> Array:
        """Observations (…, seen + n) of one batch as all have them."""
        wide = np.zeros((*observations.shape[:-1], self._width), np.float32)
        wide[..., : self.seen] = observations[..., : self.seen]
        wide[..., self._last + index] = 1.0
        if self._told:
            order = self.batches[index].blades.plant.blade_states // 2
            parts = np.split(observations, np.cumsum([self.seen, order, order]), axis=-1)
            for place, part in zip((self.seen, self.seen + self._half, self.seen + 2 * self._half), parts[1:], strict=True):
                wide[..., place : place + part.shape[-1]] = part
        return wide

    def step_async(self, actions: Array) -> None:
        """Hand the actions to the batches."""
        for batch, own in zip(self.batches, np.split(actions, self._bounds), strict=True):
            batch.step_async(own)

    def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
        """What the batches return, together."""
        observations, rewards, ends, infos = zip(*(batch.step_wait() for batch in self.batches), strict=True)
        wide = np.concatenate([self._widened(k, rows) for k, rows in enumerate(observations)])
        ended = np.concatenate(ends)
        return wide, np.concatenate(rewards), ended, self._all(infos) if ended.any() else self._unfinished

    def _all(self, infos: Sequence[list[dict[str, Any]]]) -> list[dict[str, Any]]:
        widened = []
        for index, own in enumerate(infos):
            for info in own:
                final = info.get("terminal_observation")
                widened.append(info if final is None else {**info, "terminal_observation": self._widened(index, final)})
        return widened

    def seed(self, seed: int | None = None) -> Sequence[int | None]:
        """The seeds of the next ``reset``: of the k-th batch, ``seed`` + k."""
        return [own for k, batch in enumerate(self.batches) for own in batch.seed(None if seed is None else seed + k)]

    def close(self) -> None:
        """Close every batch."""
        for batch in self.batches:
            batch.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """The attribute of each index's batch."""
        values = [value for batch in self.batches for value in batch.get_attr(attr_name)]
        return [values[index] for index in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Not offered: see ``BladeVecEnv``."""
        self.batches[0].set_attr(attr_name, value, indices)

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Not offered: see ``BladeVecEnv``."""
        return self.batches[0].env_method(method_name, *method_args, indices=indices, **method_kwargs)

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """No blade has wrappers of its own."""
        return [False] * len(list(self._get_indices(indices)))
