"""What ``predict`` is given, read the same way by every controller of this package."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from beamenv.configuration import Refused
from beamenv.configuration.arrays import real_numbers

_DOUBLE = np.dtype(np.float64)

_LARGEST = 1e100
"""Of an observation: products of larger numbers leave the range of 64 bits, and a memory would never forget that."""


def observed(observation: Any, name: str, reads: str = "observation", length: int | None = None) -> Array:
    """An observation (p,) or a batch (N, p) as float64; ``ValueError`` unless it holds finite numbers, ``length`` a blade."""
    seen = observation
    if type(seen) is not np.ndarray or seen.dtype is not _DOUBLE:  # a blade alone has no time to look closer
        seen = real_numbers("observation", observation)
    if seen.ndim not in (1, 2) or length not in (None, seen.shape[-1]):
        wanted = f"{reads} vectors" if length is None else f"{reads} vectors of length {length}"
        raise ValueError(f"observation has shape {seen.shape}, but {name} takes {wanted}, alone or in rows.")
    if not (np.abs(seen) <= _LARGEST).all():  # nor what is no number
        raise Refused("observation", observation, f"finite {reads} vectors of numbers not beyond {_LARGEST:g}")
    return seen


def remembered(state: Any, episode_start: Any, batch: tuple[int, ...], order: int) -> Array:
    """The memory (*batch, order) that a decision starts from: zero without a state, and where an episode starts.

    Raises ValueError for a state that no ``predict`` of this controller returned, and for starts that are not one a blade.
    """
    if state is None:
        return np.zeros((*batch, order))
    if not isinstance(state, np.ndarray) or state.shape != (*batch, order) or state.dtype.kind != "f":
        raise Refused("state", state, f"None, or what predict returned last, numbers of shape {(*batch, order)}")
    if episode_start is None:
        return state
    begins = _begins(episode_start, batch)
    return np.where(begins[..., None], 0.0, state) if begins.any() else state


def _begins(episode_start: Any, batch: tuple[int, ...]) -> NDArray[np.bool_]:
    """(*batch,): true where an episode starts."""
    try:
        begins = np.asarray(episode_start)
    except (TypeError, ValueError, RuntimeError):  # rows of different lengths
        begins = np.array(None)
    if begins.dtype.kind not in "biuf" or begins.size != math.prod(batch):
        raise Refused("episode_start", episode_start, f"None, or {math.prod(batch)} of True and False, one a blade")
    return np.asarray(begins.reshape(batch), dtype=bool)
