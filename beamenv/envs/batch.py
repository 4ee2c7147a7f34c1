"""The natively batched environment that ``gymnasium.make_vec("beamenv/RotatingBeam-v0")`` makes."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from beamenv.arrays import Arrays
from beamenv.blade.config import BladeConfig
from beamenv.blade.model_blade import PlantArgument
from beamenv.configuration import Count, checked
from beamenv.configuration.keywords import known_keywords
from beamenv.configuration.memory import check_room
from beamenv.envs.batch_arguments import batch_reset, chosen_mode, drawn_rows
from beamenv.envs.batch_blades import blades_of, masked, of_rows
from beamenv.envs.of_task import OfTask
from beamenv.envs.seeds import SeededVectorEnv, Seeds
from beamenv.envs.specification import Specified
from beamenv.envs.states import check_state
from beamenv.plant.spread import Spread
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.motion import Motion
from beamenv.task import (
    STEADY_INFO,
    DesignArgument,
    DType,
    Task,
    checked_action,
    checked_dtype,
    checked_task,
    information,
    resolve_task,
    steady_information,
)

if TYPE_CHECKING:
    from beamenv.rendering import BatchRenderer

Array = NDArray[np.float64]

BLADE = 2048
"""Bytes that a blade of a batch takes, at the default 1980."""
Mask = NDArray[np.bool_]
Rows = NDArray[np.int64]


class RotatingBeamVectorEnv(Specified, OfTask, SeededVectorEnv):
    """``num_envs`` blades, each in an episode of its own: a batch of ``RotatingBeamEnv`` with the same stepping kernel.

    In scenarios with several plants (`off-speed`, `off-model`) every episode draws its plant from one bank. In `spin-up` each
    blade is at its own time of the spin-up; `delay` and `failure` draw faults blade by blade. ``rotor_speed`` (N,) and
    ``design_state`` (N, d) hold the values of each blade.

    ```python
    >>> import gymnasium, beamenv
    >>> envs = gymnasium.make_vec("beamenv/RotatingBeam-v0", num_envs=4096)
    >>> observations, info = envs.reset(seed=0)
    >>> observations.shape
    (4096, 4)

    ```

    The arguments ``preset``, ``speed``, ``blade``, ``design``, ``scenario``, ``duration``, ``physical_units``, ``plant`` and
    ``spread`` are those of ``RotatingBeamEnv``; the others are

    - `num_envs`: how many blades, default 1.
    - `dtype`: with None, the default, the batch steps with 64 bits and has spaces of `"float32"`, as a single blade has. With
      `"float64"` the spaces have 64 bits too. With `"float32"` it also steps with 32 bits and returns only such numbers: about
      twice as fast. If each blade has its own seed, the episodes are then the same, and results agree within 10⁻⁴ of the largest;
      with one seed for the batch, noise is drawn with 32 bits and differs.
    - `autoreset_mode`: an `AutoresetMode` or its value. `"NextStep"` (Gymnasium's own default): the step after the last one of an
      episode ignores the action, begins the next episode and returns its first observation with reward 0. `"SameStep"` (what
      Stable-Baselines3 expects): the last step returns the first observation and info of the next episode, and those of the
      finished one as `info["final_obs"]` and `info["final_info"]`. `"Disabled"`: nothing begins by itself; blades whose episode
      has ended must begin another one by `reset(options={"reset_mask": mask})`, with a mask (N,) of bools, before the next step.
    - `max_episode_steps`: a time limit in control intervals, if it is to be shorter than `duration`.
    - `render_mode`: None or `"rgb_array"`; `render_index`: which blade is drawn, or a sequence of several. `render` returns a
      tuple of one picture for each of them. None, the default, draws all blades, as Gymnasium's wrappers expect. A batch of more
      than 64 needs a choice, because each drawn blade takes 20 MB, and 40 ms a picture.

    **Seeds.** `reset(seed=7)` makes one generator for the whole batch: fast. `reset(seed=[7, 8, ...])`, one for each blade,
    gives each blade its own, and with it exactly the load cases and noise, bit for bit, that `RotatingBeamEnv` has after
    `reset(seed=7)`: now and in its later episodes, whatever else is in the batch. With None among the seeds, that blade keeps its
    generator. `np_random` and `np_random_seed` are then tuples, one entry for each blade. `reset()` never re-seeds.

    **Info.** `volts` (N, m), asked for, after saturation; `tip_displacement` (N, 2); `energy`, `effort` and `cost_increment` (N,).
    Each has Gymnasium's mask, `_volts` and so on. For blades that begin an episode, in `reset` or in a step, there are also
    `static_stretch`, `static_untwist`, `static_strain`, `static_strain_at` (N,) and `note`, as in `RotatingBeamEnv`.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 50, "autoreset_mode": AutoresetMode.NEXT_STEP}
    controller = ""
    """Who acts, for the title line of pictures; set it before ``reset``."""

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
        dtype: Any = None,
        plant: PlantArgument | None = None,
        spread: Spread | Mapping[str, Any] | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        max_episode_steps: int | None = None,
        render_mode: str | None = None,
        render_index: int | Sequence[int] | None = None,
    ) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode is {render_mode!r}, but must be None or one of {self.metadata['render_modes']}.")
        self.render_mode = render_mode
        self.num_envs = checked("num_envs", num_envs, Count())
        check_room("num_envs", self.num_envs, BLADE, "blades")
        is_drawn = render_mode is not None or render_index is not None
        self._drawn = drawn_rows("render_index", render_index, self.num_envs) if is_drawn else ()
        self._time_limit = sys.maxsize if max_episode_steps is None else checked("max_episode_steps", max_episode_steps, Count())
        self._arrays = Arrays("float64" if dtype is None else checked_dtype(dtype))
        self._dtype: DType = "float32" if dtype is None else self._arrays.precision
        self.autoreset_mode = chosen_mode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode}
        self.set_task([resolve_task(preset, speed, blade, design, scenario, duration, physical_units, plant, spread)])

    def set_task(self, tasks: Sequence[Task]) -> None:
        """Take on tasks, blade k that at k modulo their number, in place of those before; what comes next must be ``reset``.

        The tasks may differ in their blades alone, and these not in how many patches they have nor in their electronics.
        ``task``, ``plant`` and ``design_plant`` are then the first blade's; ``tasks`` has them all.
        """
        tasks = [checked_task(task) for task in tasks]
        blades = blades_of(tasks, self.num_envs, self._arrays)  # what cannot be built is refused before anything has changed
        self.task, self.tasks, self._blades = tasks[0], tuple(tasks), blades
        notes = np.empty((2, len(tasks)), dtype=object)
        for k, task in enumerate(tasks):
            notes[:, k] = task.note, task.plant.assumed
        self._notes = notes[:, np.arange(self.num_envs) % len(tasks)]
        self.single_action_space = self.task.action_space(self._dtype)
        self.single_observation_space = self.task.observation_space(self._dtype)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._actions_shape = (self.num_envs, *self.single_action_space.shape)
        self._steps = min(self.task.steps, self._time_limit)
        self._generators = None
        self._elapsed = np.zeros(self.num_envs, dtype=np.int64)
        self._over: Rows = np.arange(0)  # rows whose episode ended, with NEXT_STEP at the last step
        self._pictures = None if self.render_mode is None else self._make_pictures(tasks)

    @property
    def steps(self) -> int:
        """Control intervals in a whole episode."""
        return self._steps

    @property
    def state(self) -> Array:
        """(N, n) the true states, hidden from an agent: the blades' in energy coordinates, then the electronics'."""
        return self._blades.state

    @property
    def coming_loads(self) -> Array:
        """(N, 2) N/m, lag and flap: the line loads of the interval to come, hidden from an agent."""
        return self._blades.coming_loads

    @property
    def design_state(self) -> Array:
        """(N, d) the true state as the design plant has its own, by displacements and velocities: for a controller that sees it."""
        return self._blades.design_state

    @property
    def rotor_speed(self) -> Any:
        """(N,) rad/s: what a tachometer shows now."""
        return self._blades.speed

    @property
    def episode_truth(self) -> Array:
        """(N, 2 + m + 2 p): which plant of the bank moves, and what is wrong now: see ``Blades.truth``."""
        return self._blades.truth

    def reset(self, *, seed: Seeds = None, options: dict[str, Any] | None = None) -> tuple[NDArray[Any], dict[str, Any]]:
        """Begin an episode of every blade. ``seed``: one for the batch, or a sequence of one for each blade.

        ``options`` are those of ``RotatingBeamEnv``; its "initial_state" may be (N, n), one for each blade. "elapsed" (N,) takes
        so many control intervals off each first episode: episodes that begin together otherwise stay in step for ever.
        "reset_mask" (N,) of bools begins episodes of these blades alone; the others go on, and are shown as they were.
        """
        asked = batch_reset(self.task, options, self._steps, self.num_envs)
        generators = self._seed(seed) if asked.rows is None else self._seed_some(seed, asked.rows)
        rows = np.arange(self.num_envs) if asked.rows is None else asked.rows
        motion = self._blades.begin(generators, asked.rows, asked.scenario, asked.initial_state)
        self._elapsed[rows] = asked.elapsed[rows]
        self._over = np.setdiff1d(self._over, rows)
        if asked.rows is None:
            self._last, info = motion, masked(information(motion))
        else:
            self._last = Motion(*(_with(whole, rows, new) for whole, new in zip(self._last, motion, strict=True)))
            info = of_rows(information(motion), rows, self.num_envs)
        if self._pictures is not None:
            if seed is not None or asked.rows is None:
                self._pictures.told(self.controller, self.np_random_seed, rows if seed is not None else rows[:0])
            self._pictures.begin(self._blades, self._last, rows)
        return self._shown(self._last.observation), {**info, **self._begun(rows)}

    def check_options(self, options: dict[str, Any] | None) -> None:
        """``ValueError`` for options that a reset would refuse."""
        batch_reset(self.task, options, self._steps, self.num_envs)

    def _shown(self, observation: Array) -> NDArray[Any]:
        """A copy in the numbers of the observation space."""
        return observation.astype(self._dtype)

    def _begun(self, rows: Rows) -> dict[str, Any]:
        """What info tells besides of ``rows`` whose episode begins, with Gymnasium's masks."""
        steady, notes = np.zeros((self.num_envs, len(STEADY_INFO))), np.full((2, self.num_envs), None, dtype=object)
        mask = np.zeros(self.num_envs, dtype=np.bool_)
        steady[rows], notes[:, rows], mask[rows] = self._blades.steady(rows), self._notes[:, rows], True
        told = steady_information(steady, *notes)
        return {**told, **{f"_{name}": mask.copy() for name in told}}

    def step(self, actions: Array) -> tuple[NDArray[Any], Array, Mask, Mask, dict[str, Any]]:
        """Hold the voltages of every blade over one control interval."""
        if self._generators is None:
            raise gymnasium.error.ResetNeeded("Call reset before step.")
        if len(self._over) and self.autoreset_mode is AutoresetMode.DISABLED:
            raise gymnasium.error.ResetNeeded(f"Episodes of blades {self._over.tolist()} have ended: reset these before step.")
        actions = checked_action(actions, self._actions_shape, self._arrays.precision)
        resting = self._over if len(self._over) else None
        motion = self._last = self._blades.step(actions, self._generators, resting)
        self._elapsed += 1
        truncated = self._elapsed >= self._steps
        if resting is not None:
            truncated[resting] = False
            self._begin(resting, motion)
        if self._pictures is not None:
            self._pictures.record(self._blades, motion, begun=resting)
        over = motion.failed | truncated
        info = information(motion)
        if over.any():
            rows = np.flatnonzero(over)
            if self.autoreset_mode is AutoresetMode.SAME_STEP:
                return self._begun_at_once(rows, motion, truncated)
            self._over = rows
        elif resting is not None:
            self._over = np.arange(0)
        info = masked(info) if resting is None else {**masked(info), **self._begun(resting)}
        return self._shown(motion.observation), motion.reward, motion.failed, truncated, info

    def _begin(self, rows: Rows, motion: Motion) -> None:
        """Begin another episode of ``rows`` and put its start into their rows of ``motion``."""
        assert self._generators is not None
        start = self._blades.begin(self._generators, rows)
        for each, first in zip(motion, start, strict=True):
            each[rows] = first
        self._elapsed[rows] = 0

    def _begun_at_once(self, rows: Rows, motion: Motion, truncated: Mask) -> tuple[NDArray[Any], Array, Mask, Mask, dict[str, Any]]:
        """SAME_STEP: what a step returns after which ``rows`` begin another episode."""
        final = of_rows({name: value[rows] for name, value in information(motion).items()}, rows, self.num_envs)
        final_obs = np.full(self.num_envs, None, dtype=object)
        for row, observation in zip(rows.tolist(), self._shown(motion.observation[rows]), strict=True):
            final_obs[row] = observation
        reward, terminated, over = motion.reward.copy(), motion.failed.copy(), np.zeros(self.num_envs, dtype=np.bool_)
        over[rows] = True
        self._begin(rows, motion)
        if self._pictures is not None:
            self._pictures.begin(self._blades, motion, rows)
        info = {**masked(information(motion)), **self._begun(rows)}
        info.update(final_obs=final_obs, _final_obs=over, final_info=final, _final_info=over.copy())
        return self._shown(motion.observation), reward, terminated, truncated, info

    def state_dict(self) -> dict[str, Any]:
        """Where a batch with one generator is, in dictionaries of arrays and numbers; ``ResetNeeded`` before the first reset.

        An equally made batch continues from it bit for bit after a reset with a seed and ``load_state_dict``.
        """
        if not isinstance(self._generators, np.random.Generator):
            raise gymnasium.error.ResetNeeded("Call reset with one seed, or none, before state_dict.")
        own = {"elapsed": self._elapsed.copy(), "over": self._over.copy(), "generator": self._generators.bit_generator.state}
        return {"blades": self._blades.state_dict(), **own}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to a ``state_dict`` of an equally made batch; ``ValueError`` of another, before anything has changed."""
        if not isinstance(self._generators, np.random.Generator):
            raise gymnasium.error.ResetNeeded("Call reset with one seed, or none, before load_state_dict.")
        check_state(state, self.state_dict())
        self._blades.load_state_dict(state["blades"])
        self._elapsed[:], self._over = np.asarray(state["elapsed"]), np.asarray(state["over"]).copy()
        self._generators.bit_generator.state = state["generator"]

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Pictures (540, 960, 3) of the blades in ``render_index``, as ``RotatingBeamEnv`` draws them."""
        if self._pictures is None:
            gymnasium.logger.warn('render was called without a render_mode: make the environment with render_mode="rgb_array".')
            return None
        if self._generators is None:
            raise gymnasium.error.ResetNeeded("Call reset before render.")
        return self._pictures.draw()

    def _make_pictures(self, tasks: Sequence[Task]) -> BatchRenderer:
        from beamenv.rendering import BatchRenderer

        drawn = {row: tasks[row % len(tasks)] for row in self._drawn}
        return BatchRenderer(drawn, self.task.observation_space().high)

    def close_extras(self, **kwargs: Any) -> None:
        """Nothing is open; but a closed environment must be reset before it is stepped."""
        self._generators = None


def _with(whole: NDArray[Any], rows: Rows, new: NDArray[Any]) -> NDArray[Any]:
    whole = whole.copy()
    whole[rows] = new
    return whole
