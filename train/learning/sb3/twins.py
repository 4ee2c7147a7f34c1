"""Blades in pairs that meet the same: what one of a pair costs, whatever it tries, is a baseline for the other.

Most of what an episode costs is the load's doing and not the voltages'. Twins have the same plant, load and noise, and
explore apart.
The advantage of one is independent of what the other tries, so that taking it from the other's leaves the gradient's mean as it is,
and takes away what chance has given both (common random numbers; Ng and Jordan 2000, Mao et al. 2019).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


class Twins(np.random.Generator):
    """Of a batch of N blades: draws for its first half, and the same again for its second.

    Where blades begin in odd numbers, a twin having failed, each draws its own.
    """

    def random(self, size: Any = None, *args: Any, **kwargs: Any) -> Any:
        """Uniform numbers, rows of (k, …) in pairs."""
        return self._paired(super().random, size, *args, **kwargs)

    def standard_normal(self, size: Any = None, *args: Any, out: Array | None = None, **kwargs: Any) -> Any:
        """Normal numbers, rows of (k, …) in pairs, or of ``out`` (blocks, columns, blades in a block)."""
        if out is None:
            return self._paired(super().standard_normal, size, *args, **kwargs)
        whole = out if len(out) > 1 else out.swapaxes(0, -1)
        half = len(whole) // 2
        whole[:half] = super().standard_normal(whole[:half].shape)
        whole[half:] = whole[:half]
        return out

    @staticmethod
    def _paired(draw: Any, size: Any, *args: Any, **kwargs: Any) -> Any:
        if not np.ndim(size) or size[0] % 2:
            return draw(size, *args, **kwargs)
        half = draw((size[0] // 2, *size[1:]), *args, **kwargs)
        return np.concatenate([half, half])


def without_the_twin(advantages: Array, loads: Array) -> Array:
    """(T, N): each advantage less that of the twin, where both still meet the same loads (T, N, 2)."""
    half = advantages.shape[1] // 2
    alike = (loads[:, :half] == loads[:, half:]).all(axis=-1)
    return advantages - np.where(np.hstack([alike, alike]), np.roll(advantages, half, axis=1), 0.0)
