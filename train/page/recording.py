"""One episode with its true states, which no sensor shows: what an animation is drawn from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

import beamenv
from baselines import Controller, no_control
from beamenv.blade.config import BladeConfig

Array = NDArray[np.float64]


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


@dataclass(frozen=True, slots=True, eq=False)
class RecordedEpisode:
    """One blade under the same loads and noise: without control, and under the two controllers that are shown side by side."""

    blade: BladeConfig
    without_control: Recording
    pair: tuple[Recording, Recording]
    """Either may be ``without_control`` itself."""

    @property
    def controlled(self) -> tuple[Recording, ...]:
        """Those of the pair that are not the episode without control."""
        return tuple(recording for recording in self.pair if recording is not self.without_control)

    @property
    def recordings(self) -> tuple[Recording, ...]:
        """Without control first, each once."""
        return (self.without_control, *self.controlled)


def record(controller: Controller, env: gym.Env[Any, Any], seed: int, options: dict[str, Any] | None = None) -> Recording:
    """One episode of one environment, to its end or the last finite state; ``options`` go to its ``reset``."""
    inner: Any = env.unwrapped
    wants_state = getattr(controller, "observes", "observation") == "state"
    observation, info = env.reset(seed=seed, options=options)
    rows, memory, ended = [_instant(inner, info)], None, False
    while not ended:
        seen = inner.state if wants_state else observation
        action, memory = controller.predict(seen[None], state=memory, episode_start=np.array([len(rows) == 1]), deterministic=True)
        observation, _, terminated, truncated, info = env.step(action[0])
        ended = terminated or truncated or not np.isfinite(inner.state).all()
        if np.isfinite(inner.state).all():
            rows.append(_instant(inner, info))
    states, tip, volts = (np.stack(series) for series in zip(*rows, strict=True))
    name = getattr(controller, "name", type(controller).__name__)
    return Recording(name, inner.plant.control_interval * np.arange(len(rows)), states, tip, volts)


def _instant(env: Any, info: Mapping[str, Any]) -> tuple[Array, ...]:
    values = (env.state, info["tip_displacement"], info["volts"])
    return tuple(np.array(value, dtype=np.float64) for value in values)


def record_episode(arguments: Mapping[str, Any], seed: int, pair: tuple[Controller, Controller]) -> RecordedEpisode:
    """The episode of ``seed`` in the environment with these keyword arguments, three times over.

    A controller called as ``baselines.laws.no_control`` is counts as the episode without control, and is not run twice.
    """
    env = gym.make(beamenv.ENV_ID, **arguments)
    try:
        inner: Any = env.unwrapped
        idle = no_control(inner.plant)
        without = record(idle, env, seed)
        left, right = (without if getattr(law, "name", None) == idle.name else record(law, env, seed) for law in pair)
        return RecordedEpisode(inner.task.config, without, (left, right))
    finally:
        env.close()
