"""Wrappers around an environment, and whether the spaces inside and outside of them hold the same numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from gymnasium.spaces import Box


def layers(env: Any) -> Iterator[Any]:
    """The wrappers around an environment, the outermost first."""
    while env is not env.unwrapped:
        yield env
        env = env.env


def alike(space: Any, own: Any) -> bool:
    """Whether two spaces of arrays hold the same numbers, in the precision that both can have."""
    if not (isinstance(space, Box) and isinstance(own, Box) and space.shape == own.shape):
        return False
    pairs = ((space.low, own.low), (space.high, own.high))
    return all(np.array_equal(one.astype(np.float32), other.astype(np.float32)) for one, other in pairs)
