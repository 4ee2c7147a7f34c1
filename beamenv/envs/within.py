"""What wrappers of this package may be put around: told in one sentence instead of observations outside their space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium
from gymnasium import wrappers
from gymnasium.vector import VectorEnv

from beamenv.configuration import Refused
from beamenv.task import Task
from beamenv.wrapping import alike, layers


def task_within(env: Any, of_batch: bool, unchanged: Sequence[str] = ("observation",), of_tensors: bool = False) -> Task:
    """The task of the blade, or batch of blades, whose observations are their readings, whose actions their voltages if so asked.

    Raises ``ValueError`` for an environment without blades, for a batch of tensors or, ``of_tensors``, of arrays, and for one
    with a wrapper that shows something else or acts otherwise.
    """
    kind: type[Any] = VectorEnv if of_batch else gymnasium.Env
    task = getattr(env.unwrapped, "task", None) if isinstance(env, kind) else None
    if not isinstance(task, Task):
        raise Refused("env", env, "a batch of blades" if of_batch else "an environment with a blade")
    if hasattr(env.unwrapped, "device") is not of_tensors:
        arrays = "tensors, such as beamenv.torch_vec makes" if of_tensors else "NumPy's arrays, such as gymnasium.make_vec makes"
        raise Refused("env", env, f"a batch of {arrays}")
    for what in unchanged:
        name = f"single_{what}_space" if of_batch else f"{what}_space"
        unlike = not alike(getattr(env, name), getattr(env.unwrapped, name))
        if unlike or (what == "observation" and _shows_otherwise(env)):
            shows = "shows the sensors' readings as they are" if what == "observation" else "takes voltages as the blade does"
            raise Refused("env", env, f"one that {shows}: put what changes its {what}s around this wrapper, not into it")
    return task


def _shows_otherwise(env: Any) -> bool:
    """Whether one of its wrappers changes what is shown, or when, though its space may tell nothing of it."""
    return any(isinstance(layer, _OTHERWISE) and not isinstance(layer, _AS_THEY_ARE) for layer in layers(env))


_OTHERWISE = (
    gymnasium.ObservationWrapper,
    gymnasium.vector.VectorObservationWrapper,
    wrappers.Autoreset,
    wrappers.MaxAndSkipObservation,
    wrappers.StickyAction,
)
_AS_THEY_ARE = (wrappers.DtypeObservation, wrappers.vector.DtypeObservation)
