"""One episode with its true states, which no sensor shows: what an animation is drawn from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

import beamenv
from baselines import Controller, no_control
from baselines.design.controller import ControllerArgument, as_controller, name_of
from baselines.evaluation.loop import instants
from beamenv.blade.build import Blade
from beamenv.blade.model_blade import ModelBlade
from beamenv.configuration import Choice, checked
from beamenv.task import Task

Array = NDArray[np.float64]
RecordingProgress = Callable[[int, int, str], None]
"""Told how many episodes are recorded, of how many, and whose is next."""

IDLE = ("none", "no control")
"""What no control is called: its id, and the name of its law."""


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """What one blade did at K instants, the reset and the end of every control interval; shorter where it failed."""

    name: str
    """Of the controller."""
    time: Array
    """(K,), s."""
    states: Array
    """(K, n), energy coordinates: ½ xᵀx in joules."""
    tip: Array
    """(K, 2), m: lag, flap."""
    volts: Array
    """(K, m), V: held over the interval that ends at each instant."""
    readings: Array = field(default_factory=lambda: np.zeros((0, 0)))
    """(K, p), in the sensors' units, noise and all; none behind a wrapper that shows something else."""
    truth: Array = field(default_factory=lambda: np.zeros((0, 0)))
    """(K, 2 + m + 2 p), as ``Blades.truth``: which plant moves and what is wrong; empty where it is the first and all is well."""
    cost: float = float("nan")
    """J s: the cost J of the episode, infinite where the blade failed."""
    load: Array = field(default_factory=lambda: np.zeros((0, 2)))
    """(K, 2), N/m: the line loads in lag and flap of the interval that begins at each instant."""


@dataclass(frozen=True, slots=True, eq=False)
class RecordedEpisode:
    """One blade under the same loads and noise, without control and under each of some controllers."""

    task: Task
    recordings: tuple[Recording, ...]
    """Without control first."""
    opens: int
    """Place of the recording that is shown first beside no control."""

    @property
    def blade(self) -> Blade:
        """The one that moves, or that those which move depart from."""
        return self.task.blade

    @property
    def without_control(self) -> Recording:
        """The first."""
        return self.recordings[0]

    @property
    def has_shape(self) -> bool:
        """Whether there is anything to be drawn in three dimensions: a model of one's own tells nothing of it."""
        return not isinstance(self.blade, ModelBlade)

    @property
    def time(self) -> Array:
        """(K,), s: of the longest recording."""
        return max((recording.time for recording in self.recordings), key=len)


def record(
    controller: ControllerArgument, env: gym.Env[Any, Any], seed: int, options: Mapping[str, Any] | None = None
) -> Recording:
    """One episode of one environment, to its end or the last finite state; ``options`` go to its ``reset``."""
    inner: Any = env.unwrapped
    rows: list[tuple[Array, ...]] = []
    cost = 0.0
    for instant in instants(controller, env, [seed], options):
        state = np.array(inner.state, dtype=np.float64)
        if not np.isfinite(state).all():
            cost = float("inf")
            break
        cost += float(instant.info["cost_increment"][0]) if rows else 0.0
        cost = float("inf") if instant.failed[0] else cost
        told = instant.info["tip_displacement"][0], instant.info["volts"][0], np.asarray(instant.observation[0])
        rows.append((state, *told, inner.episode_truth, inner.coming_loads))
    states, tip, volts, observed, truth, load = (np.stack(series) for series in zip(*rows, strict=True))
    name = name_of(as_controller(controller))
    scale = 1.0 if inner.task.physical_units else inner.plant.sensor_full_scale
    readings = scale * observed if env.observation_space == inner.observation_space else np.zeros((0, 0))
    time = inner.plant.control_interval * np.arange(len(rows))
    return Recording(name, time, states, tip, volts, readings, truth, cost, load)


def record_episode(
    arguments: Mapping[str, Any],
    seed: int,
    controllers: Mapping[str, Controller],
    opens: str | None = None,
    progress: RecordingProgress | None = None,
) -> RecordedEpisode:
    """The episode of ``seed`` in the environment with these keyword arguments, without control and under each of the controllers.

    They are called by their keys. One whose own name is in ``IDLE`` counts as the episode without control, and is
    not run. ``opens`` is the key of the one that is shown first, None that of the first. ``progress`` is called before each
    recording. Raises ``ValueError`` for a key that there is not.
    """
    env = gym.make(beamenv.ENV_ID, **{"dtype": "float64", **arguments})
    try:
        inner: Any = env.unwrapped
        idle = no_control(inner.plant)
        others = {name: law for name, law in controllers.items() if name_of(law) not in IDLE}
        place = 1 + list(others).index(checked("opens", opens, Choice(tuple(others)))) if opens is not None else min(1, len(others))
        recordings = []
        for done, (name, law) in enumerate([(idle.name, idle), *others.items()]):
            if progress is not None:
                progress(done, 1 + len(others), name)
            recordings.append(replace(record(law, env, seed), name=name))
        return RecordedEpisode(inner.task, tuple(recordings), place)
    finally:
        env.close()
