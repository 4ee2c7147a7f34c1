"""A controller in the loop, instant by instant, through the Gymnasium API alone: the one loop that everybody draws from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import gymnasium as gym
import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from baselines.design.controller import Array, ControllerArgument, as_controller

Environment: TypeAlias = "gym.Env[Any, Any] | VectorEnv[Any, Any, Any]"
INFO = ("cost_increment", "effort", "tip_displacement", "volts")
"""Keys of the environment's ``info`` that an instant holds."""


@dataclass(frozen=True, slots=True, eq=False)
class Instant:
    """N blades at their reset or at the end of a control interval."""

    observation: Any
    """(N, …): what is observed then, of a new episode where one has begun in the same step."""
    info: Mapping[str, Array]
    """(N, …) each of ``INFO``: at the end of the interval itself, not at the start of a new episode. Not all of it at a reset."""
    running: NDArray[np.bool_]
    """(N,): the episode had not ended before the interval; what is given of the others belongs to no episode."""
    failed: Array
    """(N,): 1 where the episode was terminated by the interval."""


def instants(
    controller: ControllerArgument, env: Environment, seeds: Sequence[int], options: Mapping[str, Any] | None = None
) -> Iterator[Instant]:
    """The reset, then every control interval of one episode for each seed, until the last of them has ended.

    There is one seed for each blade of ``env``, one environment or a batch, which is reset with them and ``options`` but not
    closed. A controller is shown what it ``observes``: the readings, these with the rotor speed or the episode's truth behind them,
    or the true state in the coordinates of the design plant. Raises ValueError for what is no controller.
    """
    controller = as_controller(controller)
    observes = getattr(controller, "observes", "observation")
    observation, info = _reset(env, seeds, options)
    memory, begins, running = None, np.ones(len(seeds), dtype=bool), np.ones(len(seeds), dtype=bool)
    yield Instant(observation, info, running.copy(), np.zeros(len(seeds)))
    while running.any():
        seen = _seen(observes, observation, env)
        action, memory = controller.predict(seen, state=memory, episode_start=begins, deterministic=True)
        observation, failed, ended, info = _step(env, action)
        yield Instant(observation, info, running.copy(), failed)
        running &= ~ended
        begins[:] = False


def attribute(env: Environment, name: str) -> Sequence[Any]:
    """Of every blade where Gymnasium vectorises single environments; else [what the one environment has for all its blades]."""
    inner: Any = env.unwrapped
    return inner.get_attr(name) if hasattr(inner, "get_attr") else [getattr(inner, name)]


def beside_observation(observes: str, env: Environment) -> Array | None:
    """What a controller is shown now besides the observation, or instead of it: (N, 1) rotor speed in rad/s, (N, k) the episode's
    truth, (N, d) the true state; None where it is shown nothing else.
    """
    if observes == "state":
        return np.vstack(attribute(env, "design_state"))
    if observes == "observation and speed":
        return np.hstack(attribute(env, "rotor_speed")).reshape(-1, 1)
    if observes == "observation and truth":
        return np.vstack(attribute(env, "episode_truth"))
    return None


def _seen(observes: str, observation: Any, env: Environment) -> Any:
    """What a controller is shown (N, …): the observation, with rotor speed (rad/s) or truth behind it, or the true state."""
    beside = beside_observation(observes, env)
    if beside is None or observes == "state":
        return observation if beside is None else beside
    return np.hstack([observation, beside])


def _reset(env: Environment, seeds: Sequence[int], options: Mapping[str, Any] | None) -> tuple[Any, dict[str, Array]]:
    """First observations (N, …) and info arrays (N, …); a single environment is a batch of one."""
    given = None if options is None else dict(options)
    if isinstance(env, VectorEnv):
        observation, info = env.reset(seed=list(seeds), options=given)  # type: ignore[arg-type] # Gymnasium's own take lists too
        return observation, {name: np.asarray(info[name]) for name in INFO if name in info}
    observation, info = env.reset(seed=seeds[0], options=given)
    return observation[None], {name: np.asarray(info[name])[None] for name in INFO if name in info}


def _step(env: Environment, action: Any) -> tuple[Any, Array, NDArray[np.bool_], dict[str, Array]]:
    """Observations (N, …), failures (N,), ends (N,) and info arrays (N, …) of the interval itself, not of a new episode's start."""
    if not isinstance(env, VectorEnv):
        observation, _, terminated, truncated, info = env.step(action[0])
        failed, ended = np.array([float(terminated)]), np.array([terminated or truncated])
        return observation[None], failed, ended, {name: np.asarray(info[name])[None] for name in INFO}
    observation, _, terminated, truncated, info = env.step(action)
    ended = terminated | truncated
    final = info.get("final_info", {})
    return observation, terminated.astype(float), ended, {name: _last(info[name], final.get(name), ended) for name in INFO}


def _last(current: Any, final: Any, ended: NDArray[np.bool_]) -> Array:
    """Where an episode ended and the next began in the same step, what was true at the end."""
    current = np.asarray(current, dtype=np.float64)
    if final is None:
        return current
    return np.where(ended.reshape(-1, *[1] * (current.ndim - 1)), np.asarray(final, dtype=np.float64), current)
