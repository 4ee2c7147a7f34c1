"""When a blade has failed: its spanwise strain at the outer face is beyond what its patches bear.

Which strain that is says the blade's ``strain_limit``: that of vibration alone, or with the strain that it stands at without.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FAILURE_STRAIN = 0.0045
"""Spanwise strain at which an episode ends: the greatest tensile strain an MFC is rated for (4500 ppm, Smart Material's data
sheet); the laminate breaks later."""


def safe_energy(strain: Array, standing: Array) -> float:
    """Vibration energy, J, below which no state strains a blade too much, whichever of the rows (…, k, n), per √J, and of the
    strains (…, k) without vibration are its own.

    |s + cᵀx| ≤ |s| + ‖c‖‖x‖ and ½ xᵀx is the energy.
    """
    steepness = np.sqrt((strain**2).sum(axis=-1))
    left = np.maximum(FAILURE_STRAIN - np.abs(standing), 0.0)
    longest = np.divide(left, steepness, out=np.full_like(left, np.inf), where=steepness > 0.0)
    return 0.5 * float(longest.min(initial=np.inf)) ** 2


def strained_too_much(strain: Array, standing: Array, state: Array) -> NDArray[np.bool_]:
    """(N,) which of the states (N, n) strain their blades, with rows (N, k, n) beside strains (N, k) without vibration, beyond the
    limit, or are no longer finite.
    """
    if not strain.shape[1]:  # where no strain is known
        return np.asarray(~np.isfinite(state).all(axis=-1))
    largest = np.abs(standing + np.einsum("nki,ni->nk", strain, state)).max(axis=-1)
    return np.asarray(~(largest <= FAILURE_STRAIN))
