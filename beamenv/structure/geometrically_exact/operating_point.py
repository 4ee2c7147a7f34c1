"""A blade at one speed, as it turns steadily."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class SteadyState(Sealed):
    """What the blade is like as it turns and nothing vibrates."""

    coefficients: Array
    """(N,): u, v, s in m and the rotation vector's components, rad, by the trial functions."""
    amplitudes: Array
    """(terms × AMPLITUDES): of the sections' shapes, by theirs."""


@dataclass(frozen=True, slots=True, eq=False)
class OperatingPoint(Sealed):
    """A blade at one speed: M q̈ + G q̇ + K q = f about its steady state."""

    speed: float
    """rad/s."""
    mass: Array
    stiffness: Array
    gyroscopic: Array
    """(N, N)"""
    steady: SteadyState | None
    """None where the model has no steady state of its own."""
    following: Array | None = None
    """(terms × AMPLITUDES, N): amplitudes of the sections' shapes per coefficient of the vibration."""

    def restricted(self, columns: NDArray[np.intp]) -> OperatingPoint:
        """The matrices of some coefficients alone, the others held at zero."""
        pick = np.ix_(columns, columns)
        return OperatingPoint(self.speed, self.mass[pick], self.stiffness[pick], self.gyroscopic[pick], None)
