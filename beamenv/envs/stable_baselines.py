"""Stable-Baselines3's ``VecEnv`` straight over the batched environment: all blades step in one call."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from beamenv.configuration import Count, Refused, checked
from beamenv.envs.seeds import checked_seed

try:
    from stable_baselines3.common.vec_env import VecEnv
except ImportError as error:
    raise ImportError('beamenv.BladeVecEnv needs Stable-Baselines3: pip install "stable-baselines3".') from error

Array = NDArray[Any]


class BladeVecEnv(VecEnv):
    """``num_envs`` blades for an agent of Stable-Baselines3; ``arguments`` are those of ``RotatingBeamVectorEnv``.

    Observations and rewards are the environment's; an agent without memory needs ``VecFrameStack`` around it. ``set_options`` takes
    the options of the next reset: one dictionary for all blades, or a list with one for each.
    """

    def __init__(self, num_envs: int = 64, seed: int | None = None, **arguments: Any) -> None:
        if "autoreset_mode" in arguments:
            raise Refused("autoreset_mode", arguments["autoreset_mode"], "left out: Stable-Baselines3 knows 'SameStep' alone")
        num_envs = checked("num_envs", num_envs, Count())
        self.envs: Any = gymnasium.make_vec(
            "beamenv/RotatingBeam-v0", num_envs=num_envs, autoreset_mode=AutoresetMode.SAME_STEP, **arguments
        )
        super().__init__(num_envs, self.envs.single_observation_space, self.envs.single_action_space)
        self.metadata["render_fps"] = self.envs.metadata["render_fps"]
        self._seed = checked_seed(seed)
        self._actions: Array = np.zeros(())

    def reset(self) -> Array:
        """Begin an episode of every blade; observations (N, p)."""
        return np.asarray(self._begin({})[0])

    def _begin(self, common: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        """Begin an episode of every blade with its own options, which go before the ``common`` ones; observations and info."""
        alike: dict[bytes, list[int]] = {}
        for row, own in enumerate(self._options):
            options = {**common, **own}
            alike.setdefault(pickle.dumps(options), []).append(row)
        groups = [({**common, **self._options[rows[0]]}, rows) for rows in alike.values()]
        for options, _ in groups:
            self.envs.unwrapped.check_options(options)
        observations, info = self.envs.reset(seed=self._seed, options=groups[0][0])
        for options, rows in groups[1:]:
            mask = np.isin(np.arange(self.num_envs), rows)
            observations, begun = self.envs.reset(options={**options, "reset_mask": mask})
            info = {name: _merged(values, begun[name], mask) for name, values in info.items()}
        self.reset_infos = [{name: values[row] for name, values in info.items() if name[0] != "_"} for row in range(self.num_envs)]
        self._seed = None
        self._reset_options()
        return observations, info

    def set_options(self, options: list[dict[str, Any]] | dict[str, Any] | None = None) -> None:
        """Options of the next reset: one dictionary for all blades, or a list of one for each."""
        super().set_options(options_of_each(options, self.num_envs))

    def get_images(self) -> Sequence[Array]:
        """Pictures of the blades that are drawn."""
        return list(self.envs.render() or ())

    def step_async(self, actions: Array) -> None:
        """Keep the actions for ``step_wait``."""
        self._actions = actions

    def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
        """Observations, rewards, ends and infos; where an episode ended the observation is the next one's first."""
        observations, rewards, terminated, truncated, info = self.envs.step(self._actions)
        ends = terminated | truncated
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for row in np.flatnonzero(ends).tolist():
            infos[row] = {"terminal_observation": info["final_obs"][row], "TimeLimit.truncated": not terminated[row]}
        return observations, rewards.astype(np.float32), ends, infos

    def seed(self, seed: int | None = None) -> Sequence[int | None]:
        """The seed of the next ``reset``, one for the whole batch."""
        self._seed = checked_seed(seed)
        return [seed] * self.num_envs

    def close(self) -> None:
        """Close the batch."""
        self.envs.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """The batch's one attribute, for each of the indices."""
        return [getattr(self.envs.unwrapped, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Not offered: the blades of a batch are one environment."""
        raise NotImplementedError(f"attr_name = {attr_name!r} cannot be set: the blades of a batch are one environment.")

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Not offered: the blades of a batch are one environment."""
        raise NotImplementedError(f"method_name = {method_name!r} cannot be called: the blades of a batch are one environment.")

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """No blade has wrappers of its own."""
        return [False] * len(list(self._get_indices(indices)))


def options_of_each(options: Any, count: int) -> list[dict[str, Any]]:
    """The options of each blade's next reset; ``ValueError`` unless one dictionary, ``count`` of them, or None."""
    each = options if isinstance(options, list) else [{} if options is None else options] * count
    if len(each) != count or not all(isinstance(one, dict) for one in each):
        raise Refused("options", options, f"a dictionary, or a list of {count} of them")
    return each


def _merged(values: Array, new: Array, mask: Array) -> Array:
    """``new`` where the mask holds."""
    merged = values.copy()
    merged[mask] = new[mask]
    return merged
