"""Wrappers that put the patches elsewhere: at given positions, in a named layout, or anew in every episode."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
from gymnasium.utils import RecordConstructorArgs
from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, Drawn, Side, resolve, with_positions
from beamenv.blade.model_blade import ModelBlade
from beamenv.configuration import Count, Refused, Table, checked, checked_table
from beamenv.envs.seeds import checked_seed, checked_seeds
from beamenv.envs.specification import plain
from beamenv.envs.within import task_within
from beamenv.patches.group import Positions
from beamenv.task import Task, reset_options

Layout = Mapping[Side, Positions | Drawn]


class PlacementWrapper(gymnasium.Wrapper[Any, Any, Any, Any], RecordConstructorArgs):
    """Moves the actuators and the sensors of a ``RotatingBeamEnv``.

    - `env`: the environment.
    - `actuators`, `sensors`: where they are to be, as in ``beamenv.blade.layouts.resolve``: None (left in place), positions in
      metres from the root, a number of patches (equally spaced), a name ("uniform", "thesis-table-6.3" for actuators,
      "thesis-table-6.4" for sensors, "optimal", which is computed once), or a range {"low": …, "high": …, "count": …} from which
      each reset draws.

    Spaces follow the number of patches. `reset(options={"layout": …})` changes the layout, from this episode on, to a name or a
    mapping {"actuators": …, "sensors": …}, with as many patches as before. `info["layout"]` has the positions.
    `unwrapped.plant` and `unwrapped.design_plant` belong to the layout: build controllers from them after `reset`. The data
    acquisition stays the same when sensors move: an observation of 1 is the same current wherever they are.

    Apply it directly to the environment, before wrappers that look at its spaces or its plant. Raises ValueError for a layout
    that does not fit the blade, and changes nothing then.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], actuators: Any = None, sensors: Any = None) -> None:
        RecordConstructorArgs.__init__(self, actuators=plain(actuators), sensors=plain(sensors))
        self._home = _with_fixed_range(_unplaced(env, of_batch=False))
        gymnasium.Wrapper.__init__(self, env)
        self._layout = _resolved(self._home.config, {"actuators": actuators, "sensors": sensors})
        self._positions = {side: _first(self._layout[side]) for side in SIDES}
        self._move_to(self._positions)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode, in another layout if ``options`` or the range say so."""
        layout, rest = _changed(self._home.config, self._layout, options, self._positions)
        seed = checked_seed(seed)
        reset_options(self.env.unwrapped.task, rest, rows=1)  # type: ignore[attr-defined] # what it refuses must be refused before anything has changed
        drawn = any(isinstance(layout[side], Drawn) for side in SIDES)
        if drawn:
            self.env.reset(seed=seed)
            seed = None
        positions = {side: _drawn(layout[side], self.np_random) if drawn else _first(layout[side]) for side in SIDES}
        self._layout = layout
        if positions != self._positions:
            self._move_to(positions)
        observation, info = self.env.reset(seed=seed, options=rest)
        return observation, {**info, "layout": dict(self._positions)}

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Step, and tell the layout."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        info["layout"] = dict(self._positions)
        return observation, reward, terminated, truncated, info

    def _task(self, positions: Mapping[Side, Positions]) -> Task:
        return _moved(self._home, positions)

    def _move_to(self, positions: Mapping[Side, Positions]) -> None:
        task = self._task(positions)
        _ = task.plant, task.design_plant  # a layout that no plant can be built of is refused here
        self.env.unwrapped.set_task(task)  # type: ignore[attr-defined]
        self._positions = dict(positions)


class VectorPlacementWrapper(VectorWrapper):  # in Gymnasium 1.2 it takes no type parameters
    """``PlacementWrapper`` for the batched environment: one layout for all blades, or one for each.

    - `env`: a `RotatingBeamVectorEnv`; `actuators`, `sensors`: as for `PlacementWrapper`.
    - `layouts`: instead of these two, a name or mapping {"actuators": …, "sensors": …} for each blade, or one for all.
    - `bank`: number of layouts drawn from a range at each `reset`, default 16; blade k has layout k modulo `bank`. (A plant takes
      some hundredths of a second to build.) An autoreset keeps the layout.

    `reset(options={"layout": …})` takes a name or a mapping for all blades, or a sequence of one for each; a side that is left
    out goes back to where `env` had it. `info["layout"]` has arrays (N, actuators) and (N, sensors). `unwrapped.plant` is the
    first blade's.
    """

    def __init__(
        self,
        env: VectorEnv[Any, Any, NDArray[Any]],
        actuators: Any = None,
        sensors: Any = None,
        layouts: Sequence[Mapping[str, Any]] | None = None,
        bank: int = 16,
    ) -> None:
        self._bank: int = checked("bank", bank, Count())
        self._home = _with_fixed_range(_unplaced(env, of_batch=True))
        super().__init__(env)
        self._own: np.random.Generator | None = None
        """What layouts are drawn with when every blade has a seed of its own; the batch's generator otherwise."""
        given: Any = {"actuators": actuators, "sensors": sensors}
        for side in SIDES:
            if layouts is not None and given[side] is not None:
                raise Refused(side, given[side], "left out where layouts are given")
        self._layouts = self._resolved("layouts", given if layouts is None else layouts)
        self._positions = [{side: _first(layout[side]) for side in SIDES} for layout in self._layouts]
        self._tasks: dict[tuple[Positions, ...], Task] = {}
        """By positions: what layouts have had their blades built for, as long as they are in use."""
        self._move_to(self._positions)

    @property
    def autoreset_mode(self) -> AutoresetMode:
        """The batch's: Gymnasium tells it in ``metadata``, and TorchRL asks for it by this name."""
        return self.env.metadata["autoreset_mode"]

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode of every blade."""
        options = _options(options)
        if options.get("reset_mask") is not None:
            return self._reset_some(seed, options)
        layouts = (
            self._resolved("options['layout']", options.pop("layout"), self._positions[0]) if "layout" in options else self._layouts
        )
        self.env.unwrapped.check_options(options)  # type: ignore[attr-defined]
        checked_seeds(seed, self.num_envs)  # what reset refuses must be refused before anything has moved
        drawn = any(isinstance(layout[side], Drawn) for layout in layouts for side in SIDES)
        if drawn:
            self.env.reset(seed=seed)
            seeds = self.np_random_seed
            if seed is not None or self._own is None:
                self._own = np.random.default_rng(seeds) if isinstance(seeds, tuple) else None
            seed = None
        positions = self._draw(layouts) if drawn else [{side: _first(layout[side]) for side in SIDES} for layout in layouts]
        self._layouts = layouts
        if positions != self._positions:
            self._move_to(positions)
        observations, info = self.env.reset(seed=seed, options=options)
        return observations, self._told(info)

    def _reset_some(self, seed: Any, options: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        """Begin episodes of some blades, whose layouts stay as at an autoreset."""
        if "layout" in options:
            raise Refused("options['layout']", options["layout"], "left out beside a reset_mask: the blades that go on keep theirs")
        observations, info = self.env.reset(seed=seed, options=options)
        return observations, self._told(info)

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Step, and tell the layouts."""
        observations, reward, terminated, truncated, info = self.env.step(actions)
        return observations, reward, terminated, truncated, self._told(info)

    def _resolved(self, name: str, given: Any, like: Mapping[Side, Positions] | None = None) -> list[Layout]:
        """One layout for all blades, or one for each."""
        if isinstance(given, np.ndarray) and given.ndim == 1 and given.dtype.kind == "O":  # what an array of mappings is
            given = given.tolist()
        if isinstance(given, (str, Mapping)):
            return [_resolved(self._home.config, given, like, name)]
        if not isinstance(given, Sequence) or len(given) != self.num_envs:
            raise Refused(name, given, f"one layout, or a sequence of {self.num_envs}, one for each blade")
        layouts = [_resolved(self._home.config, each, like, f"{name}[{k}]") for k, each in enumerate(given)]
        counts = {tuple(len(_first(layout[side])) for side in SIDES) for layout in layouts}
        if len(counts) > 1:
            raise ValueError(f"layouts have {sorted(counts)} actuators and sensors, but those of one batch must have equally many.")
        return layouts

    def _draw(self, layouts: Sequence[Layout]) -> list[dict[Side, Positions]]:
        generator = self.np_random if self._own is None else self._own
        number = len(layouts) if len(layouts) > 1 else min(self._bank, self.num_envs)
        return [{side: _drawn(layouts[k % len(layouts)][side], generator) for side in SIDES} for k in range(number)]

    def _move_to(self, positions: list[dict[Side, Positions]]) -> None:
        kept, self._tasks = self._tasks, {}
        for each in positions:
            key = tuple(each[side] for side in SIDES)
            self._tasks[key] = self._tasks.get(key) or kept.get(key) or _moved(self._home, each)
        tasks = [self._tasks[tuple(each[side] for side in SIDES)] for each in positions]
        self.env.unwrapped.set_task([replace(task) for task in tasks])  # type: ignore[attr-defined] # they share blades, not banks
        self._positions = positions
        which = np.arange(self.num_envs) % len(positions)
        self._whole = {side: np.array([each[side] for each in positions])[which] for side in SIDES}
        """(N, patches), m: each blade's positions."""

    def _told(self, info: dict[str, Any]) -> dict[str, Any]:
        everywhere = np.ones(self.num_envs, dtype=np.bool_)
        layout: dict[str, Any] = {side: whole.copy() for side, whole in self._whole.items()}
        layout.update({f"_{side}": everywhere.copy() for side in SIDES})
        return {**info, "layout": layout, "_layout": everywhere}


def _unplaced(env: Any, of_batch: bool) -> Task:
    """The task of the environment within, which must not be placed by another such wrapper already."""
    task, inner = task_within(env, of_batch, ("observation", "action")), env
    if isinstance(task.blade, ModelBlade):
        raise Refused("env", env, "one with a blade, on which patches can be placed, and no model of one's own")
    while inner is not env.unwrapped:
        if isinstance(inner, (PlacementWrapper, VectorPlacementWrapper)):
            raise Refused("env", env, "one whose patches no other wrapper places")
        inner = inner.env
    return task


def _with_fixed_range(task: Task) -> Task:
    """The task with the data acquisition that its blades have now, wherever their sensors go."""
    return _of_blades(task, lambda blade: blade.with_fixed_range().with_fixed_order())


def _moved(task: Task, positions: Mapping[Side, Positions]) -> Task:
    """The task with the patches of the true and of the design blade at other positions."""
    return _of_blades(task, lambda blade: blade.changed(with_positions(blade.config, positions)))


def _of_blades(task: Task, changed: Callable[[Blade], Blade]) -> Task:
    """The task with its true and its design blade changed, which stay one where they are one."""
    blade = changed(task.blade)
    return replace(task, blade=blade, design_blade=blade if task.design_blade == task.blade else changed(task.design_blade))


def _resolved(config: BladeConfig, given: Any, like: Mapping[Side, Positions] | None = None, name: str = "layout") -> Layout:
    """Each side's layout; ``ValueError`` for what does not fit, or has other numbers of patches than ``like``."""
    asked = _both_sides(name, given)
    layout = {side: resolve(config, side, asked.get(side)) for side in SIDES}
    for side in SIDES:
        count = len(_first(layout[side]))
        if like is not None and count != len(like[side]):
            raise ValueError(f"options['layout'] has {count} {side}, but the spaces are made for {len(like[side])}.")
    return layout


def _both_sides(name: str, given: Any) -> Mapping[str, Any]:
    if isinstance(given, str):
        return dict.fromkeys(SIDES, given)
    if not isinstance(given, Mapping):
        raise Refused(name, given, f"a name or a mapping with the keys {' and '.join(SIDES)}")
    return checked_table(name, given, SIDES)


def _options(options: Any) -> dict[str, Any]:
    """A copy of the options of a reset; the environment checks what the layout leaves of them."""
    return {} if options is None else dict(checked("options", options, Table()))


def _changed(
    config: BladeConfig, layout: Layout, options: Mapping[str, Any] | None, positions: Mapping[Side, Positions]
) -> tuple[Layout, dict[str, Any]]:
    """The layout that the options of a reset ask for, and the other options."""
    rest = _options(options)
    if "layout" not in rest:
        return layout, rest
    return _resolved(with_positions(config, positions), rest.pop("layout"), positions), rest


def _first(layout: Positions | Drawn) -> Positions:
    """Positions to begin with: a range's are equally spaced."""
    return tuple(layout.bounds.uniform().tolist()) if isinstance(layout, Drawn) else layout


def _drawn(layout: Positions | Drawn, generator: np.random.Generator) -> Positions:
    return layout.draw(generator) if isinstance(layout, Drawn) else layout
