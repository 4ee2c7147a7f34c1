"""The wrapper that shows the recent past of a batch of tensors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorWrapper
from gymnasium.vector.utils import batch_space

from beamenv.envs.history import normalised_plant
from beamenv.envs.states import check_state
from beamenv.envs.torch_batch import Step, TorchRotatingBeamVectorEnv
from beamenv.plant.plant import drive_limit

BEGUN = "_static_stretch"
"""The mask in info of the blades whose episode begins."""


class TorchSensorHistory(VectorWrapper):  # in Gymnasium 1.2 it takes no type parameters
    """``VectorSensorHistory`` for `beamenv.torch_vec`, in each of its autoreset modes: a step stays on the device.

    - `env`: a `TorchRotatingBeamVectorEnv` with normalised units.
    - `length`: instants shown, default 12.

    With `differentiable=True` the graph leads back through the past; `detach()` cuts it, here and in the blades.
    With SAME_STEP `info["final_obs"]` holds the histories at the end of the finished episodes.
    """

    env: TorchRotatingBeamVectorEnv

    def __init__(self, env: TorchRotatingBeamVectorEnv, length: int = 12) -> None:
        plant, length = normalised_plant(env, length, of_batch=True, of_tensors=True)
        super().__init__(env)
        dtype, drive = env.single_observation_space.dtype, drive_limit(plant)
        self._width = len(plant.C) + len(drive)
        self.single_observation_space = Box(-1.0, 1.0, (length * self._width,), dtype.type)  # type: ignore[union-attr]
        self.observation_space = batch_space(self.single_observation_space, env.num_envs)
        self._window = torch.zeros(
            env.num_envs, length * self._width, dtype=getattr(torch, str(dtype)), device=env.unwrapped.device
        )
        self._drive = torch.as_tensor(drive, dtype=self._window.dtype, device=self._window.device)
        self._same_step = self.autoreset_mode is AutoresetMode.SAME_STEP

    @property
    def autoreset_mode(self) -> AutoresetMode:
        """The batch's."""
        return self.env.unwrapped.autoreset_mode

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[torch.Tensor, dict[str, Any]]:
        """Begin every episode with an empty past, or those of a "reset_mask" alone."""
        readings, info = self.env.reset(seed=seed, options=options)
        self._window = self._begun(readings, info[BEGUN])
        return self._window.clone(), info

    def step(self, actions: Any) -> Step:
        """Step and show the past of each blade."""
        readings, reward, terminated, truncated, info = self.env.step(actions)
        last, told = (info["final_obs"], info["final_info"]) if self._same_step else (readings, info)
        self._window = torch.cat([self._window[:, self._width :], last, told["volts"] / self._drive], -1)
        if self._same_step:
            info["final_obs"] = self._window
        if BEGUN in info:
            self._window = self._begun(readings, info[BEGUN])
        return self._window.clone(), reward, terminated, truncated, info

    def _begun(self, readings: torch.Tensor, mask: torch.Tensor) -> torch.Tensor:
        """The windows, where the mask says so of an episode of which there is nothing but readings."""
        past, voltages = self._window[:, self._width :], readings.new_zeros(len(readings), len(self._drive))
        return torch.where(mask[:, None], torch.cat([torch.zeros_like(past), readings, voltages], -1), self._window)

    def detach(self) -> None:
        """Cut the windows, and all that moves, from the graph that they came of."""
        self.env.unwrapped.detach()
        self._window = self._window.detach()

    def state_dict(self) -> dict[str, Any]:
        """The windows; the blades' own state is ``unwrapped.state_dict()``."""
        return {"window": self._window.clone()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of an equally made wrapper; ``ValueError`` of another."""
        check_state(state, self.state_dict())
        self._window = state["window"].to(self._window).clone()
