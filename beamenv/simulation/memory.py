"""How a batch of blades lies in memory, column by column: in (blocks, size) blades, or in groups of a plant each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.simulation.kernel import row_product

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

_BLOCK = 256
"""Blades that lie together in memory: BLAS multiplies blocks of this size fastest."""

_PAGE, _SHIFT = 64, 24
"""Columns of groups begin this many numbers after a multiple of that: powers of two apart they would share the cache's lines."""


@dataclass(frozen=True, slots=True)
class Run:
    """Neighbouring groups of equally many blades, of which one product takes care."""

    rows: slice
    groups: slice
    shape: tuple[int, int, int]
    """(groups, blocks, size)"""

    def of(self, array: NDArray[Any]) -> NDArray[Any]:
        """Its rows of (1, N, columns), seen as (groups, blocks, size, columns)."""
        return array[0, self.rows].reshape(*self.shape, -1)


@dataclass(frozen=True, slots=True)
class Arrangement:
    """Where in memory the blades of a batch are."""

    shape: tuple[int, ...]
    """() for a blade alone, (blocks, size), or (1, N) where there are groups."""
    runs: tuple[Run, ...] = ()
    """The groups; none where all blades are of one."""

    @classmethod
    def of(cls, sizes: Sequence[int] | None) -> Arrangement:
        """That of so many blades in each group; None is a blade alone."""
        if sizes is None or len(sizes) == 1:
            return cls(() if sizes is None else batch_shape(sizes[0]))
        runs, start = [], 0
        for size, groups in groupby(range(len(sizes)), sizes.__getitem__):
            first, *further = groups
            count = 1 + len(further)
            blocks, each = batch_shape(size)
            runs.append(Run(slice(start, start + count * size), slice(first, first + count), (count, blocks, each)))
            start += count * size
        return cls((1, sum(sizes)), tuple(runs))

    def columns_first(self, columns: int) -> tuple[Array, Array]:
        """Zeros that lie in memory as (blocks, column, blade), and the same seen as (blocks, blade, column): fast for large
        batches, since every column is contiguous. Both (column,) for a blade alone.
        """
        *blocks, size = self.shape or (0,)
        spread = -size % _PAGE + _SHIFT if self.runs else 0
        memory = np.zeros((*blocks, columns, size + spread))[..., :size] if self.shape else np.zeros(columns)
        return memory, memory.swapaxes(-2, -1) if self.shape else memory

    def rows_of(self, rows: Rows) -> tuple[Rows, ...]:
        """Index of ``rows`` in arrays of the batch's shape."""
        return np.divmod(rows, self.shape[-1]) if self.shape else ()

    def product(self, rows: Any, matrix: Any, out: Any = None) -> Any:
        """As ``row_product``; but matrices (groups, k, l) are one for each group's rows."""
        if not self.runs or matrix.ndim != 3:
            return row_product(rows, matrix, out)
        out = np.empty((*self.shape, matrix.shape[-1])) if out is None else out
        for run in self.runs:
            row_product(run.of(rows), matrix[run.groups, None], run.of(out))
        return out


class Instant(NamedTuple):
    """What the blades are and meet at one instant, and where the product of the instant before goes: views of one memory."""

    joined: Array
    """(…, s): state, voltages, loads."""
    state: Array
    voltages: Array
    loads: Array
    energetic: Array
    """(…, b): the blade's own states."""
    product: Array
    """(…, w): begins with the state."""

    @classmethod
    def of(cls, memory: Array, states: int, voltages: int, loads: int, own: int, width: int) -> Instant:
        """Views of a memory (…, at least s and w): of so many states, voltages, loads, states of the blade's own, and columns w."""
        driven, size = states + voltages, states + voltages + loads
        return cls(
            joined=memory[..., :size],
            state=memory[..., :states],
            voltages=memory[..., states:driven],
            loads=memory[..., driven:size],
            energetic=memory[..., :own],
            product=memory[..., :width],
        )


def batch_shape(count: int) -> tuple[int, int]:
    """(blocks, size) with size near ``_BLOCK`` where count has such a divisor."""
    size = next((size for size in range(min(count, _BLOCK), _BLOCK // 4, -1) if count % size == 0), count)
    return count // size, size
