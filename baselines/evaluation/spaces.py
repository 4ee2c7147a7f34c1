"""What is read and driven through wrappers: refused where it is not what the blade itself shows and takes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, TypeAlias

from gymnasium import wrappers
from gymnasium.spaces import Box
from gymnasium.vector import VectorEnv

from baselines.evaluation.conditions import tasks_of
from beamenv.configuration import Refused
from beamenv.wrapping import alike, layers

Side: TypeAlias = Literal["action", "observation"]
_CLIPS = (wrappers.ClipAction, wrappers.vector.ClipAction)
"""They take whatever number, and hand on what the blade takes."""
_NORMALISES = (wrappers.NormalizeObservation, wrappers.vector.NormalizeObservation)
"""Up to Gymnasium 1.2 the spaces of batches do not tell it."""
_SKIPS = (wrappers.MaxAndSkipObservation,)
_WANTED = {
    "action": "one that takes voltages as the blade does, where zero is no control: leave out the wrapper that changes its actions",
    "observation": "one that shows the sensors' readings as they are to a controller that reads them: leave out the wrapper that "
    "changes its observations",
}


def check_spaces(env: Any, unchanged: Sequence[Side]) -> None:
    """``ValueError`` for observations that are no arrays, for skipped control intervals, and where wrappers change a side."""
    shown_as = space_of(env, "observation")
    if not isinstance(shown_as, Box):
        raise Refused("env", env, f"one whose observations are arrays, in a Box, and not in {type(shown_as).__name__}")
    if any(isinstance(layer, _SKIPS) for layer in layers(env)):
        raise Refused("env", env, "one that tells of every control interval: leave out the wrapper that skips some")
    for side in unchanged:
        if _is_changed(env, side):
            raise Refused("env", env, _WANTED[side])


def space_of(env: Any, side: Side) -> Any:
    """That of one blade."""
    return getattr(env, f"single_{side}_space" if isinstance(env, VectorEnv) else f"{side}_space")


def _is_changed(env: Any, side: Side) -> bool:
    """Whether a wrapper, of the batch or of a blade in it, has another space than what it wraps."""
    for layer in layers(env):
        if side == "observation" and isinstance(layer, _NORMALISES):
            return True
        if not isinstance(layer, _CLIPS) and not alike(space_of(layer, side), space_of(layer.env, side)):
            return True
    inner = env.unwrapped
    if blades := getattr(inner, "envs", None):
        return any(_is_changed(blade, side) for blade in blades)
    tasks = tasks_of(env) if hasattr(inner, "get_attr") else ()  # of processes, whose wrappers cannot be seen
    own = [task.action_space() if side == "action" else task.observation_space() for task in tasks[:1]]
    return any(not alike(space_of(inner, side), space) for space in own)
