"""When a blade has failed: its spanwise strain at the outer face is beyond what its patches bear.

What they bear is the least ``failure_strain`` of their sheets, wherever on the blade the strain is: 0.45 % for MFC, less for
monolithic ceramics. Which strain that is says the blade's ``strain_limit``: that of vibration alone, or with the strain that it
stands at without.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import namespace

Array = NDArray[np.float64]


def safe_energy(strain: Array, standing: Array, limit: Array) -> float:
    """Vibration energy, J, below which no state strains a blade too much, whichever of the rows (…, k, n), per √J, of the
    strains (…, k) without vibration and of the limits (…,) are its own.

    |s + cᵀx| ≤ |s| + ‖c‖‖x‖ and ½ xᵀx is the energy.
    """
    steepness = np.sqrt((strain**2).sum(axis=-1))
    left = np.maximum(limit[..., None] - np.abs(standing), 0.0)
    longest = np.divide(left, steepness, out=np.full_like(left, np.inf), where=steepness > 0.0)
    return 0.5 * float(longest.min(initial=np.inf)) ** 2


def strained_too_much(strain: Any, standing: Any, limit: Any, state: Any) -> Any:
    """(N,) which of the states (N, n) strain their blades, with rows (N, k, n) beside strains (N, k) without vibration, beyond
    their limits (N,), or are no longer finite.
    """
    array = namespace(state)
    if not strain.shape[-2]:  # where no strain is known
        return ~array.isfinite(state).all(-1)
    moved = array.einsum("nki,ni->nk", strain, state) if strain.ndim == 3 else state @ strain.swapaxes(-1, -2)
    strains = array.abs(standing + moved)
    return ~(array.amax(strains, -1) <= limit)
