"""Blades that fail: one rule for what such an episode costs, and the count of those that a controller saves and loses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RULE = (
    "Where the blade fails without control, J₀ counts the rest of the episode as its last interval, so that it is a number. A "
    "controller under which it fails too has neither saved nor lost it: its J counts as J₀. One that keeps it whole has saved "
    "it: its J counts as it is. One that breaks a blade which stands without control has lost it: J and J / J₀ are infinite, and "
    "the score is minus infinity. Saved and lost episodes are counted over all seeds and runs; none is left out. Settling, peaks "
    "and effort of a blade that fails are those up to its failure; it does not settle."
)
"""What an episode in which a blade fails counts as, for whoever shows one."""


@dataclass(frozen=True, slots=True)
class Failures:
    """Episodes of one controller in one scenario."""

    episodes: int
    """Runs × seeds."""
    fail_without: int
    """In so many of them the blade fails without control."""
    saved: int
    """In so many of those it stands under the controller."""
    lost: int
    """In so many of the others it fails under the controller."""


def failures(cost: Array, fails: Array) -> Failures:
    """Of J (K, N), infinite where the blade failed, and of whether it ``fails`` (N,) without control, 1 or 0."""
    broken, without = np.isinf(cost), np.broadcast_to(fails > 0.0, cost.shape)
    return Failures(cost.size, int(without.sum()), int((without & ~broken).sum()), int((broken & ~without).sum()))
