"""One episode with its true states, which no sensor shows: what an animation is drawn from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
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

Array = NDArray[np.float64]


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


@dataclass(frozen=True, slots=True, eq=False)
class RecordedEpisode:
    """One blade under the same loads and noise: without control, and under the two controllers that are shown side by side."""

    blade: Blade
    """The one that moves."""
    without_control: Recording
    pair: tuple[Recording, Recording]
    """Either may be ``without_control`` itself."""

    @property
    def has_shape(self) -> bool:
        """Whether there is anything to be drawn in three dimensions: a model of one's own tells nothing of it."""
        return not isinstance(self.blade, ModelBlade)

    @property
    def controlled(self) -> tuple[Recording, ...]:
        """Those of the pair that are not the episode without control."""
        return tuple(recording for recording in self.pair if recording is not self.without_control)

    @property
    def recordings(self) -> tuple[Recording, ...]:
        """Without control first, each once."""
        return (self.without_control, *self.controlled)


def record(
    controller: ControllerArgument, env: gym.Env[Any, Any], seed: int, options: Mapping[str, Any] | None = None
) -> Recording:
    """One episode of one environment, to its end or the last finite state; ``options`` go to its ``reset``."""
    inner: Any = env.unwrapped
    rows: list[tuple[Array, ...]] = []
    for instant in instants(controller, env, [seed], options):
        state = np.array(inner.state, dtype=np.float64)
        if not np.isfinite(state).all():
            break
        rows.append((state, instant.info["tip_displacement"][0], instant.info["volts"][0], np.asarray(instant.observation[0])))
    states, tip, volts, observed = (np.stack(series) for series in zip(*rows, strict=True))
    name = name_of(as_controller(controller))
    scale = 1.0 if inner.task.physical_units else inner.plant.sensor_full_scale
    readings = scale * observed if env.observation_space == inner.observation_space else np.zeros((0, 0))
    return Recording(name, inner.plant.control_interval * np.arange(len(rows)), states, tip, volts, readings)


def record_episode(arguments: Mapping[str, Any], seed: int, pair: tuple[Controller, Controller]) -> RecordedEpisode:
    """The episode of ``seed`` in the environment with these keyword arguments, three times over.

    A controller of an id or a name in ``IDLE`` counts as the episode without control, and is not run twice.
    """
    env = gym.make(beamenv.ENV_ID, **{"dtype": "float64", **arguments})
    try:
        inner: Any = env.unwrapped
        idle = no_control(inner.plant)
        without = record(idle, env, seed)
        left, right = (without if getattr(law, "name", None) in IDLE else record(law, env, seed) for law in pair)
        return RecordedEpisode(inner.task.blade, without, (left, right))
    finally:
        env.close()
