"""When a blade has failed: its spanwise strain at the outer face is beyond what its patches bear."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FAILURE_STRAIN = 0.0045
"""Spanwise strain at which an episode ends: the greatest tensile strain an MFC is rated for (4500 ppm, Smart Material's data
sheet); the laminate breaks later."""


def safe_energy(strain: Array) -> float:
    """Vibration energy, J, below which no state strains a blade too much, whichever of the rows (…, k, n), per √J, are its own.

    |cᵀx| ≤ ‖c‖‖x‖ and ½ xᵀx is the energy.
    """
    steepest = float(np.sqrt((strain**2).sum(axis=-1)).max(initial=0.0))
    return np.inf if steepest == 0.0 else 0.5 * (FAILURE_STRAIN / steepest) ** 2


def strained_too_much(strain: Array, state: Array) -> NDArray[np.bool_]:
    """(N,) which of the states (N, n) strain their blades, with rows (N, k, n), beyond the limit, or are no longer finite."""
    largest = np.abs(np.einsum("nki,ni->nk", strain, state)).max(axis=-1)
    return np.asarray(~(largest <= FAILURE_STRAIN))
