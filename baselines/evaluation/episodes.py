"""Episodes recorded through the Gymnasium API alone: any controller, one environment or a batch, paired by seed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import gymnasium as gym
import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from baselines.design.controller import Array, Controller

Environment: TypeAlias = "gym.Env[Any, Any] | VectorEnv[Any, Any, Any]"
_INFO = ("cost_increment", "effort", "tip_displacement", "volts")
_NO_LOAD = {"load": {"case": "none"}}
Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True, eq=False)
class Episodes:
    """What N blades did over T control intervals; NaN after the end of a blade that failed early."""

    seeds: tuple[int, ...]
    cost: Array
    """(T, N), J s: increments of J."""
    effort: Array
    """(T, N), J s: the actuators' share of them."""
    tip_displacement: Array
    """(T, N, 2), m, at the end of each interval: lag, flap."""
    load_response: Array
    """(T, N, 2), m: the part of it that the load case caused, without the tremor under white load and sensor noise: the tip
    displacement less that of a second run on the same seed, in which the load case is absent."""
    voltages: Array
    """(T, N, m), V, as applied."""
    failed: NDArray[np.bool_]
    """(N,): the episode was terminated before its time limit."""
    voltage_limits: Array
    """(2, m), V."""
    interval: float
    """s."""

    @property
    def time(self) -> Array:
        """(T,), s, since the reset."""
        return np.asarray(self.interval * np.arange(1, len(self.cost) + 1))


def roll_out(controller: Controller, env: Environment, seeds: Sequence[int], progress: Progress | None = None) -> Episodes:
    """One episode for each seed. Equal seeds mean equal loads and noise, so that controllers are compared in pairs.

    Each seed is run twice, the second time for ``Episodes.load_response``. ``env`` is one environment or a batch, filled as
    often as it takes; it is reset but not closed. ``progress`` is called with the number of episodes done and their total.
    Raises ValueError for no seeds.
    """
    seeds = tuple(int(seed) for seed in seeds)
    if not seeds:
        raise ValueError("seeds is empty, but an evaluation needs at least one seed")
    width = env.num_envs if isinstance(env, VectorEnv) else 1
    parts = []
    for first in range(0, len(seeds), width):
        batch = seeds[first : first + width]
        padded = batch + batch[-1:] * (width - len(batch))
        loaded, unloaded = (_run(controller, env, padded, options) for options in (None, _NO_LOAD))
        parts.append([series[:, : len(batch)] for series in (*loaded, unloaded[2])])
        if progress is not None:
            progress(first + len(batch), len(seeds))
    length = max(len(series) for part in parts for series in part)
    cost, effort, tip, voltages, failed, tremor = (_side_by_side(series, length) for series in zip(*parts, strict=True))
    plant = _attribute(env, "plant")[0]
    return Episodes(
        seeds=seeds,
        cost=cost,
        effort=effort,
        tip_displacement=tip,
        load_response=tip - tremor,
        voltages=voltages,
        failed=np.nansum(failed, axis=0) > 0,
        voltage_limits=plant.voltage_limits,
        interval=plant.control_interval,
    )


def _run(controller: Controller, env: Environment, seeds: tuple[int, ...], options: dict[str, Any] | None) -> tuple[Array, ...]:
    """Cost, effort (T, N), tip (T, N, 2), voltages (T, N, m) and failures (T, N) of one episode each, NaN once it is over."""
    observes = getattr(controller, "observes", "observation")
    observation, memory = _reset(env, seeds, options), None
    begins, running = np.ones(len(seeds), dtype=bool), np.ones(len(seeds), dtype=bool)
    steps: list[tuple[Array, ...]] = []
    while running.any():
        seen = _seen(observes, observation, env)
        action, memory = controller.predict(seen, state=memory, episode_start=begins, deterministic=True)
        observation, failed, ended, info = _step(env, action)
        recorded = (*(info[name] for name in _INFO), failed)
        steps.append(tuple(np.where(running.reshape(-1, *[1] * (series.ndim - 1)), series, np.nan) for series in recorded))
        running &= ~ended
        begins[:] = False
    return tuple(np.stack(series) for series in zip(*steps, strict=True))


def _seen(observes: str, observation: Any, env: Environment) -> Any:
    """What a controller is shown (N, …): the observation, with the rotor speed (rad/s) behind it, or the true state instead."""
    if observes == "state":
        return np.vstack(_attribute(env, "design_state"))
    if observes == "observation and speed":
        return np.hstack([observation, np.hstack(_attribute(env, "rotor_speed")).reshape(-1, 1)])
    return observation


def _reset(env: Environment, seeds: tuple[int, ...], options: dict[str, Any] | None) -> Any:
    """First observations (N, …); a single environment is a batch of one."""
    if isinstance(env, VectorEnv):
        return env.reset(seed=list(seeds), options=options)[0]  # type: ignore[arg-type] # Gymnasium's own environments take lists too
    return env.reset(seed=seeds[0], options=options)[0][None]


def _step(env: Environment, action: Any) -> tuple[Any, Array, NDArray[np.bool_], dict[str, Array]]:
    """Observations (N, …), failures (N,), ends (N,) and info arrays (N, …) of the interval itself, not of a new episode's start."""
    if not isinstance(env, VectorEnv):
        observation, _, terminated, truncated, info = env.step(action[0])
        failed, ended = np.array([float(terminated)]), np.array([terminated or truncated])
        return observation[None], failed, ended, {name: np.asarray(info[name])[None] for name in _INFO}
    observation, _, terminated, truncated, info = env.step(action)
    ended = terminated | truncated
    final = info.get("final_info", {})
    return observation, terminated.astype(float), ended, {name: _last(info[name], final.get(name), ended) for name in _INFO}


def _last(current: Any, final: Any, ended: NDArray[np.bool_]) -> Array:
    """Where an episode ended and the next began in the same step, what was true at the end."""
    current = np.asarray(current, dtype=np.float64)
    if final is None:
        return current
    return np.where(ended.reshape(-1, *[1] * (current.ndim - 1)), np.asarray(final, dtype=np.float64), current)


def _attribute(env: Environment, name: str) -> Sequence[Any]:
    """Of every blade where Gymnasium vectorises single environments; else [what the one environment has for all its blades]."""
    inner: Any = env.unwrapped
    return inner.get_attr(name) if hasattr(inner, "get_attr") else [getattr(inner, name)]


def _side_by_side(parts: Sequence[Array], length: int) -> Array:
    """Records (T, N, …) beside each other along N, continued with NaN to the same length."""
    return np.concatenate(
        [np.concatenate([part, np.full((length - len(part), *part.shape[1:]), np.nan)]) for part in parts], axis=1
    )
