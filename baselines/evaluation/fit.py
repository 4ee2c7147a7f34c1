"""Whether a controller and an environment belong together: what does not is refused before anything moves."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import VectorEnv

from baselines.design.controller import Array, Controller, name_of
from baselines.design.law import Law
from baselines.evaluation.conditions import check_alike
from baselines.evaluation.loop import Environment, attribute
from baselines.evaluation.spaces import check_spaces
from beamenv.configuration import Refused, shown
from beamenv.task import Task

ENVIRONMENT = "an environment with a blade, a batch of them, or the id of one"


def made(env: Any, count: int) -> Environment:
    """A batch of so many blades by its id; ``ValueError`` for an id that nobody has registered."""
    try:
        return gym.make_vec(env, num_envs=count)
    except (gym.error.Error, ImportError, TypeError) as error:
        raise ValueError(f"env is {shown(env)}, but must be {ENVIRONMENT}: {' '.join(str(error).split()).rstrip('.')}.") from None


def check_fit(controller: Controller, env: Any) -> None:
    """``ValueError`` for what is no environment with blades, or with unlike ones, and for a controller in other units, with another
    clock, or within wrappers that change what it reads or drives.

    A law or an agent of this package says what it reads and drives, a model of Stable-Baselines3 tells its spaces. Of a plain
    function nothing is known.
    """
    check_environment(env)
    check_alike(env)
    task = getattr(env.unwrapped, "task", None)
    if isinstance(task, Task):
        _check_units(controller, task.physical_units)
        check_state_told(controller, task)
    if isinstance(controller, Law):
        _check_clock(controller, attribute(env, "plant")[0].control_interval)
        if isinstance(task, Task) and not task.physical_units:
            _check_full_scale(controller, task.plant.sensor_full_scale)
    _check_model(controller, env)
    check_spaces(env, ("action", "observation") if _reads_the_sensors(controller) else ("action",))


def check_state_told(controller: Controller, task: Task) -> None:
    """``ValueError`` for a law of the true state where plants move whose states are not in the design's coordinates."""
    if getattr(controller, "observes", "observation") == "state":
        task.truth.check_state_told()


def _reads_the_sensors(controller: Controller) -> bool:
    """Whether it is a law or an agent of this package that wants the sensors' readings as the blade gives them."""
    if isinstance(controller, Law):
        return controller.observes != "state"
    return hasattr(controller, "physical_units")


def check_environment(env: Any) -> None:
    """``ValueError`` for what is no environment with blades."""
    if not isinstance(env, (gym.Env, VectorEnv)):
        hint = ", not a VecEnv of Stable-Baselines3" if hasattr(env, "step_wait") else ""
        raise Refused("env", env, ENVIRONMENT + hint)
    try:
        attribute(env, "plant")
    except AttributeError:
        raise Refused("env", env, ENVIRONMENT) from None


def _check_units(controller: Controller, physical_units: bool) -> None:
    if isinstance(controller, Law):
        fits, remedy = controller.instruments.fit(physical_units), "law.in_physical_units() gives a law for it"
    else:
        fits, remedy = getattr(controller, "physical_units", physical_units) is physical_units, "make the environment without it"
    if not fits:
        kind, other = "a law" if isinstance(controller, Law) else "an agent", "without" if physical_units else "with"
        raise ValueError(
            f"controller = {name_of(controller)} is {kind} for an environment {other} physical_units=True, which this one is not: "
            f"{remedy}"
        )


def _check_clock(law: Law, interval: float) -> None:
    if not np.isclose(law.instruments.interval, interval, rtol=1e-6):
        raise ValueError(
            f"controller = {law.name} decides every {law.instruments.interval:g} s, but the environment wants one that does every "
            f"{interval:g} s."
        )


def _check_full_scale(law: Law, full_scale: Array) -> None:
    """A reading of 1 must be to the law what it is on the blade."""
    if law.observes == "state":
        return
    taken = law.instruments.measurement_scale[: len(full_scale)]  # behind them, what else it sees
    for sensor, (own, there) in enumerate(zip(taken, full_scale, strict=False), start=1):
        if not np.isclose(own, there, rtol=1e-6):
            raise ValueError(
                f"controller = {law.name} takes a reading of 1 of sensor {sensor} for {own:.6g}, but in the environment that is "
                f"{there:.6g}, its full scale: design it for a plant of this full scale, such as env.unwrapped.design_plant."
            )


def _check_model(controller: Controller, env: Environment) -> None:
    """Of a model that tells its spaces: their shapes, and that both or neither count in drive limits."""
    batch = isinstance(env, VectorEnv)
    for name in ("observation", "action"):
        own = getattr(controller, f"{name}_space", None)
        there = getattr(env, f"single_{name}_space" if batch else f"{name}_space")
        if not isinstance(own, Box) or not isinstance(there, Box):
            continue
        if own.shape != there.shape or (name == "action" and _normalised(own) is not _normalised(there)):
            raise ValueError(
                f"controller = {name_of(controller)} has the {name} space {own}, but must have the environment's, {there}, "
                "within the wrappers that it was trained in."
            )


def _normalised(space: Box) -> bool:
    return bool(np.all(space.low == -1.0) and np.all(space.high == 1.0))
