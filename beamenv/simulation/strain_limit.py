"""When a blade has failed: its spanwise strain at the outer face is beyond what its patches bear.

What they bear is the least ``failure_strain`` of their sheets, wherever on the blade the strain is: 0.45 % for MFC, less for
monolithic ceramics. Which strain that is says the blade's ``strain_limit``: that of vibration alone, or with the strain that it
stands at without.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import Arrays, namespace, on_host

Array = NDArray[np.float64]

_BELOW = 1.0 - 1e-6
"""A kernel takes numbers with 32 bits, which must not be more than they were."""


def safe_energy(strain: Array, standing: Array, limit: Array) -> float:
    """Vibration energy, J, below which no state strains a blade too much, whichever of the rows (…, k, n), per √J, of the
    strains (…, k) without vibration and of the limits (…,) are its own.

    |s + cᵀx| ≤ |s| + ‖c‖‖x‖ and ½ xᵀx is the energy.
    """
    steepness = np.sqrt((strain**2).sum(axis=-1))
    left = np.maximum(limit[..., None] - np.abs(standing), 0.0)
    longest = np.divide(left, steepness, out=np.full_like(left, np.inf), where=steepness > 0.0)
    return 0.5 * float(longest.min(initial=np.inf)) ** 2


@dataclass(frozen=True, slots=True, eq=False)
class StrainLimit:
    """What the plants of a bank bear; arrays of the blades that have these plants."""

    strain: Any
    """(K, s, n) per √J."""
    standing: Any
    """(K, s)"""
    limit: Any
    """(K,)"""
    safe: float
    """``safe_energy`` of them all."""
    arrays: Arrays

    def failed(self, energy: Any, increment: Any, moving: Callable[[], Any], index: Any) -> Any:
        """(N,) whether blades with plants ``index`` (N,) have failed, or () of a blade alone, by their energy in J.

        Only a blade with enough energy can have, and only then are its strains worked out of the states (N, n) that ``moving``
        gives. A GPU's kernel does the same block by block; what is recorded without one works out all, for it may not look. Where
        no strain is known only what is no longer a number has failed, be it in the ``increment`` of J alone.
        """
        energy = energy if self.strain.shape[-2] else energy + increment
        if not self.arrays.looks:
            kernels = self.arrays.kernels if self.strain.shape[-2] else None
            if kernels is not None:
                tables = self.strain, self.standing, self.limit
                return kernels.strained_too_much(energy.detach(), moving().detach(), *tables, index, _BELOW * self.safe)
            own = 0 if len(self.limit) == 1 else index
            return strained_too_much(self.strain[own], self.standing[own], self.limit[own], moving())
        if not energy.ndim:
            return bool(not energy <= self.safe and self._strained([0], moving()[None], index)[0])
        failed = energy < -np.inf
        if not energy.max() <= self.safe:  # a NaN is not safe either
            rows = np.flatnonzero(~(on_host(energy) <= self.safe))
            failed[rows] = self._strained(rows, moving(), index)
        return failed

    def _strained(self, rows: Any, states: Any, index: Any) -> Any:
        own = index[rows]
        return strained_too_much(self.strain[own], self.standing[own], self.limit[own], states[rows])


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
