"""Sections of the rigid theory, whose shear strains cost nothing: what is left of their energies and stresses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHEARS = slice(0, 2)


def without_shear(energy: Array) -> Array:
    """Energies (V, STRAINS, STRAINS) of sections that shear as they please, their shear strains held to cost nothing."""
    free = energy - energy[:, :, SHEARS] @ np.linalg.solve(energy[:, SHEARS, SHEARS], energy[:, SHEARS, :])
    free[:, SHEARS, :] = free[:, :, SHEARS] = 0.0
    return free


def moments_without_shear(moments: Array, energy: Array) -> Array:
    """Moments (V, 6, STRAINS) of the spanwise stress in such sections."""
    free = moments - moments[:, :, SHEARS] @ np.linalg.solve(energy[:, SHEARS, SHEARS], energy[:, SHEARS, :])
    free[:, :, SHEARS] = 0.0
    return free
