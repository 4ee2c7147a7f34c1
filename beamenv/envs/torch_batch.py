"""The batched environment of tensors that ``beamenv.torch_vec`` makes, on a GPU or on the processor."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from beamenv.arrays import Arrays
from beamenv.blade.config import BladeConfig
from beamenv.blade.model_blade import PlantArgument
from beamenv.configuration import Count, Flag, checked
from beamenv.configuration.keywords import known_keywords
from beamenv.configuration.memory import check_room
from beamenv.envs.batch_arguments import BatchReset, batch_reset, chosen_mode
from beamenv.envs.of_task import OfTask
from beamenv.envs.seeds import SeededVectorEnv
from beamenv.envs.states import check_state
from beamenv.envs.torch_arguments import (
    checked_actions,
    checked_device,
    checked_precision,
    checked_recording,
    host_options,
    torch,
    torch_seed,
)
from beamenv.envs.torch_episodes import Outcome, TorchEpisodes
from beamenv.envs.torch_graph import RecordedStep
from beamenv.plant.spread import Spread
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.blades import Blades
from beamenv.simulation.motion import Motion
from beamenv.task import INFO, STEADY_INFO, DesignArgument, Task, information, resolve_task

BLADE = 4096
"""Bytes that a blade takes on the processor, at the default 3000."""

Step = tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor, dict[str, Any]]


class TorchRotatingBeamVectorEnv(OfTask, SeededVectorEnv):
    """``num_envs`` blades on a device: ``RotatingBeamVectorEnv`` whose observations, rewards, ends and info are torch's tensors.

    Noise and load cases are drawn on the device, and episodes begin there: a step copies nothing to or from the host, and does not
    wait for the device.

    ```python
    >>> import beamenv, torch
    >>> envs = beamenv.torch_vec(num_envs=1024, device="cpu")
    >>> observations, info = envs.reset(seed=0)
    >>> observations.shape, observations.dtype
    (torch.Size([1024, 4]), torch.float32)
    >>> observations, rewards, terminated, truncated, info = envs.step(torch.zeros(1024, 4))

    ```

    The arguments ``preset``, ``speed``, ``blade``, ``design``, ``scenario``, ``duration``, ``physical_units``, ``plant``,
    ``spread``, ``autoreset_mode`` and ``max_episode_steps`` are those of ``RotatingBeamVectorEnv``; the others are

    - `device`: `"cpu"`, `"cuda"`, or `"cuda:1"` of several; None, the default, is the GPU if there is one, else the processor.
    - `dtype`: `"float32"` (the default) or `"float64"`: the numbers of the spaces and of what is stepped.
    - `differentiable`: keep the graph from actions to all that follows of them, across steps, until `detach()`. Otherwise steps
      run without gradients. Where an episode begins, nothing passes from the one before.
    - `graph`: on a GPU, capture the step as a CUDA graph and replay it. For a small batch, starting the kernels one by one takes
      longer than running them.
    - `compiled`: trace the step and compile it (TorchInductor; on the processor that takes a C++ compiler): fewer passes over the
      memory, for 5 to 30 s at the first step. With either, steps are the same operations whatever the numbers are; where each
      blade has a seed of its own they are not recorded.

    **Actions** are a tensor (N, m) on the device; an array of NumPy, such as the action space samples, is taken too, and copied.
    On the processor, numbers that are not finite are refused. On a GPU they are not looked for, because that would mean to wait for
    the device: the blade's state is then not finite either, and its episode terminates.

    **Seeds.** `reset(seed=7)` seeds one generator of torch's on the device. The same seed gives the same episodes on the same
    kind of device with the same `dtype`, `num_envs`, arguments and release of torch; they are not NumPy's, but have the same
    distribution. `reset(seed=[7, 8, ...])`, one for each blade, gives each blade the very episodes that `RotatingBeamEnv` has
    after `reset(seed=7)`, within rounding (1e-10 of the largest number with 64 bits, 1e-4 with 32): what is random is then drawn
    on the host, and each step copies it to the device. `reset()` never re-seeds.

    **Autoreset.** As `RotatingBeamVectorEnv`'s; but every step tells the same names: with `"SameStep"` also `final_obs` (N, p) and
    `final_info`, with both that begin episodes also `static_stretch`, …, and the masks `_final_obs`, `_static_stretch`, … say for
    which blades they hold. On a GPU every step begins another episode for all blades, and a mask keeps those that are due: that
    takes less time than to wait for the device. With `"Disabled"`, a step of blades whose episode is over is refused on the
    processor; on a GPU they go on.

    **Info** is that of `RotatingBeamVectorEnv` without `note` and `assumed`, which are text: see `task.note`. The masks of what
    holds for all blades are one tensor, which is not to be written to.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    @known_keywords("the environment")
    def __init__(
        self,
        num_envs: int = 1,
        preset: str = "thesis",
        speed: float | None = None,
        blade: BladeConfig | Mapping[str, Any] | None = None,
        design: DesignArgument = None,
        scenario: Scenario | Mapping[str, Any] | str | None = None,
        duration: float | None = None,
        physical_units: bool = False,
        dtype: Any = "float32",
        plant: PlantArgument | None = None,
        spread: Spread | Mapping[str, Any] | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        max_episode_steps: int | None = None,
        device: str | torch.device | None = None,
        differentiable: bool = False,
        graph: bool = False,
        compiled: bool = False,
    ) -> None:
        self.num_envs = checked("num_envs", num_envs, Count())
        check_room("num_envs", self.num_envs, BLADE, "blades")
        limit = sys.maxsize if max_episode_steps is None else checked("max_episode_steps", max_episode_steps, Count())
        self.device, precision = checked_device(device), checked_precision(dtype)
        self.differentiable = checked("differentiable", differentiable, Flag())
        self.autoreset_mode = chosen_mode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode}
        self.task: Task = resolve_task(preset, speed, blade, design, scenario, duration, physical_units, plant, spread)
        self.single_action_space = self.task.action_space(precision)
        self.single_observation_space = self.task.observation_space(precision)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._captures, self._compiles = checked_recording(graph, compiled, self.device, self.differentiable, self.task.scenario)
        self._arrays = Arrays(precision, str(self.device), recorded=self._captures or self._compiles, compiled=self._compiles)
        blades = Blades(self.task.bank, self.task.scenario, self.num_envs, self.task.physical_units, self._arrays)
        self._episodes = TorchEpisodes(blades, min(self.task.steps, limit), self.autoreset_mode)
        self._zeros, self._all = self._arrays.zeros(0), torch.ones(self.num_envs, dtype=torch.bool, device=self.device)
        self._actions_shape = (self.num_envs, *self.single_action_space.shape)
        self._torch_generator = torch.Generator(self.device)
        self._draws_from: Any = None
        self._recorded: RecordedStep | None = None
        self._begun_in = self.task.scenario
        self._last: Any = None

    @property
    def generator(self) -> torch.Generator | None:
        """Torch's, on the device, that episodes are drawn from; None before a reset, and where each blade has its own of NumPy."""
        return self._draws_from if isinstance(self._draws_from, torch.Generator) else None

    @property
    def steps(self) -> int:
        """Control intervals in a whole episode."""
        return self._episodes.steps

    @property
    def state(self) -> torch.Tensor:
        """(N, n) the true states, hidden from an agent: the blades' in energy coordinates, then the electronics'."""
        return self._episodes.blades.state

    @property
    def design_state(self) -> torch.Tensor:
        """(N, d) the true state as the design plant has its own, by displacements and velocities: for a controller that sees it."""
        return self._episodes.blades.design_state

    @property
    def coming_loads(self) -> torch.Tensor:
        """(N, 2) N/m, lag and flap: the line loads of the interval to come, hidden from an agent."""
        return self._episodes.blades.coming_loads

    @property
    def rotor_speed(self) -> torch.Tensor:
        """(N,) rad/s: what a tachometer shows now."""
        return self._episodes.blades.speed

    @property
    def episode_truth(self) -> torch.Tensor:
        """(N, 2 + m + 2 p): which plant of the bank moves, and what is wrong now: see ``Blades.truth``."""
        return self._episodes.blades.truth

    def _seed(self, seed: Any) -> Any:
        """The generators of all blades: NumPy's of each, or torch's, seeded from that of the batch."""
        generators = super()._seed(seed)
        if not isinstance(generators, np.random.Generator):
            self._draws_from = generators
        elif seed is not None or self.generator is None:
            self._draws_from = self._torch_generator  # always the same: a graph draws from it
            self._draws_from.manual_seed(torch_seed(self.np_random_seed))
        return self._draws_from

    def _seed_some(self, seed: Any, rows: Any) -> Any:
        generators = super()._seed_some(seed, rows)
        return self._draws_from if isinstance(generators, np.random.Generator) else generators

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[torch.Tensor, dict[str, Any]]:
        """Begin an episode of every blade. ``seed`` and ``options`` are those of ``RotatingBeamVectorEnv``; arrays among the
        options may be tensors, which are copied to the host.
        """
        asked = batch_reset(self.task, host_options(options), self.steps, self.num_envs)
        with torch.set_grad_enabled(self.differentiable and torch.is_grad_enabled()):
            generators = self._seed(seed) if asked.rows is None else self._seed_some(seed, asked.rows)
            motion, mask = self._episodes.begin(generators, asked)
            self._go_on(asked)
            if asked.rows is not None:
                motion = self._last = _with(self._last, self._arrays.exact(asked.rows), motion)
        self._last = motion
        return motion.observation.clone(), {**_masked(information(motion), mask), **self._steady(mask)}

    def step(self, actions: Any) -> Step:
        """Hold the voltages of every blade over one control interval; all that is returned are tensors on the device."""
        if self._draws_from is None:
            raise gymnasium.error.ResetNeeded("Call reset before step.")
        if self.autoreset_mode is AutoresetMode.DISABLED and self._arrays.on_host and bool(self._episodes.over.any()):
            over = self._episodes.over.nonzero()[:, 0].tolist()
            raise gymnasium.error.ResetNeeded(f"Episodes of blades {over} have ended: reset these before step.")
        with torch.set_grad_enabled(self.differentiable and torch.is_grad_enabled()):
            outcome = self._step(checked_actions(actions, self._actions_shape, self._zeros, self._arrays))
            self._last = outcome.shown
            observation = self._to_keep(outcome.shown.observation)
            return observation, outcome.reward, outcome.terminated, outcome.truncated, self._information(outcome)

    def _step(self, actions: torch.Tensor) -> Outcome:
        if not self._arrays.recorded or self.generator is None:
            return self._episodes.step(actions, self._draws_from)
        if self._recorded is None:
            self._recorded = RecordedStep(self._episodes, actions, self.generator, self._compiles, self._captures)
        return self._recorded(actions)

    def _go_on(self, asked: BatchReset | None = None) -> None:
        """Let the recorded step go on from where the episodes are now; one of another scenario is recorded anew."""
        if asked is not None and asked.rows is None and asked.scenario != self._begun_in:
            self._recorded, self._begun_in = None, asked.scenario
        if self.generator is None:
            self._recorded = None
        if self._recorded is not None:
            self._recorded.renew()

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_recorded": None}  # it is of this memory

    def _information(self, outcome: Outcome) -> dict[str, Any]:
        info = _masked(information(outcome.shown), self._all)
        if outcome.begun is None:
            return info
        info.update(self._steady(outcome.begun))
        if outcome.final is not None:
            info.update(final_obs=self._to_keep(outcome.final.observation), _final_obs=outcome.begun)
            info.update(final_info=_masked(information(outcome.final), outcome.begun), _final_info=outcome.begun)
        return info

    def _to_keep(self, observation: torch.Tensor) -> torch.Tensor:
        """The observation for the caller to keep: the electronics may remember theirs, unless the step is a recorded one."""
        return observation if self._recorded is not None else observation.clone()

    def _steady(self, mask: torch.Tensor) -> dict[str, Any]:
        """What info tells besides of blades whose episode begins."""
        told = zip(STEADY_INFO, self._episodes.blades.steady().unbind(-1), strict=True)
        return {key: value for name, each in told for key, value in ((name, each), (f"_{name}", mask))}

    def detach(self) -> None:
        """Cut all that moves from the graph that it came of: gradients of what follows do not pass further back."""
        self._episodes.blades.detach()

    def state_dict(self) -> dict[str, Any]:
        """Where a batch with one generator is, in dictionaries of tensors; ``ResetNeeded`` before the first reset.

        An equally made batch on the same kind of device continues from it bit for bit after a reset with a seed and
        ``load_state_dict``.
        """
        if self.generator is None:
            raise gymnasium.error.ResetNeeded("Call reset with one seed, or none, before state_dict.")
        return {**self._episodes.state_dict(), "generator": self.generator.get_state()}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of an equally made batch; ``ValueError`` of another, before anything has changed."""
        if self.generator is None:
            raise gymnasium.error.ResetNeeded("Call reset with one seed, or none, before load_state_dict.")
        check_state(state, self.state_dict())
        self._episodes.load_state_dict(state)
        self._go_on()
        self.generator.set_state(state["generator"].cpu())

    def close_extras(self, **kwargs: Any) -> None:
        """Nothing is open; but a closed environment must be reset before it is stepped."""
        self._generators = self._draws_from = None


def _masked(info: dict[str, Any], mask: torch.Tensor) -> dict[str, Any]:
    """Info with Gymnasium's mask "_key" beside every key: which rows it holds for."""
    return {**info, **{f"_{name}": mask for name in INFO}}


def _with(whole: Motion, rows: torch.Tensor, new: Motion) -> Motion:
    return Motion(*(each.index_put((rows,), own) for each, own in zip(whole, new, strict=True)))


def torch_vec(num_envs: int = 1, device: str | torch.device | None = None, **arguments: Any) -> TorchRotatingBeamVectorEnv:
    """``num_envs`` blades whose arrays are torch's tensors on a device, the GPU if there is one; ``arguments`` are those of
    ``TorchRotatingBeamVectorEnv``.
    """
    return TorchRotatingBeamVectorEnv(num_envs, device=device, **arguments)
