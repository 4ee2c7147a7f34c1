"""How a batch of blades lies in memory: (blocks, size) blades, each block column by column."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

_BLOCK = 256
"""Blades that lie together in memory: BLAS multiplies blocks of this size fastest."""


def batch_shape(count: int | None, groups: int = 1) -> tuple[int, ...]:
    """Shape of the batch: () for a blade alone, else (blocks, size) with size near ``_BLOCK`` where count has such a divisor.

    Blades of several equal ``groups``, one after the other, share no block.
    """
    if count is None:
        return ()
    each = count // groups
    size = next((size for size in range(min(each, _BLOCK), _BLOCK // 4, -1) if each % size == 0), each)
    return count // size, size


def columns_first(shape: tuple[int, ...], columns: int) -> tuple[Array, Array]:
    """Zeros that lie in memory as (blocks, column, blade), and the same seen as (blocks, blade, column): fast for large
    batches, since every column is contiguous. Both (column,) for the shape () of a single blade.
    """
    memory = np.zeros((*shape[:-1], columns, *shape[-1:]))
    return memory, memory.swapaxes(-2, -1) if shape else memory


def place(rows: Rows, shape: tuple[int, ...]) -> tuple[Rows, ...]:
    """Index of ``rows`` in arrays of the batch's shape."""
    return np.divmod(rows, shape[-1]) if shape else ()
