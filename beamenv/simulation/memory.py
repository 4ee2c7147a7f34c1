"""How a batch of blades lies in memory: column by column in (blocks, size) blades or groups of a plant each; tensors by blade."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import Arrays, SomeRows, copied, namespace
from beamenv.simulation.kernel import Multiply, Operators, advance, row_product, views_of, weighted

Array = NDArray[Any]
Rows = NDArray[np.int64]

_BLOCK = 256
"""Blades that lie together in memory: BLAS multiplies blocks of this size fastest."""

_SMALL = 1_000_000
"""Products of up to so many multiplications BLAS does without rearranging the matrices first, a third faster."""

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
    """() for a blade alone, (blocks, size), or (1, N) where there are groups; (N,) of tensors."""
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

    def columns_first(self, columns: int, dtype: str = "float64") -> tuple[Array, Array]:
        """Zeros that lie in memory as (blocks, column, blade), and the same seen as (blocks, blade, column): fast for large
        batches, since every column is contiguous. Both (column,) for a blade alone.
        """
        *blocks, size = self.shape or (0,)
        spread = -size % _PAGE + _SHIFT if self.runs else 0
        memory = np.zeros((*blocks, columns, size + spread), dtype)[..., :size] if self.shape else np.zeros(columns, dtype)
        return memory, memory.swapaxes(-2, -1) if self.shape else memory

    def those(self, rows: Any) -> SomeRows:
        """Blades by their rows."""
        return SomeRows(rows, (rows,) if len(self.shape) == 1 else np.divmod(rows, self.shape[-1]) if self.shape else ())

    def product(self, rows: Any, matrix: Any, out: Any = None) -> Any:
        """As ``row_product``; but matrices (groups, k, l) are one for each group's rows."""
        if not self.runs or matrix.ndim != 3:
            return row_product(rows, matrix, out) if matrix.ndim > 2 or out is None else product_in_parts(rows, matrix, out)
        out = np.empty((*self.shape, matrix.shape[-1]), matrix.dtype) if out is None else out
        for run in self.runs:
            product_in_parts(run.of(rows), matrix[run.groups, None], run.of(out))
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


Sizes = tuple[int, int, int]
"""Voltages, loads, and states of the blade's own."""


class InPlace:
    """The states of blades in NumPy's memory, which a step writes to: column by column where blades of a group have one plant,
    blade by blade for a plant each, as BLAS likes it.
    """

    def __init__(self, lie: Arrangement, operators: Operators, sizes: Sizes, arrays: Arrays, by_column: bool) -> None:
        n, (m, k, b), width = operators.states, sizes, operators.fused.shape[-1]
        self.squares: Array
        """(…, b) of the blade's own states, which are kept from one instant to the next."""
        memories: list[Array] = []
        for columns in (*[max(n + m + k, width)] * 2, m, b):
            by_blade = np.zeros((*lie.shape, columns), arrays.precision)
            memories.append(lie.columns_first(columns, arrays.precision)[1] if by_column else by_blade)
        *both, self.weighted, self.squares = memories
        self._now, self._then = (Instant.of(each, n, m, k, b, width) for each in both)
        there = self._now, self._then
        self._views, self._next_views = (views_of(operators, one.joined, other.product) for one, other in (there, there[::-1]))

    @property
    def state(self) -> Array:
        """(…, n), as the batch lies: a view."""
        return self._now.state

    @property
    def loads(self) -> Array:
        """(…, k): where loads are to be written."""
        return self._now.loads

    def join(self, acting: Array, loads: Array) -> tuple[Array, Array]:
        """[state, voltages, loads] (…, s), of which the loads have been written, and the voltages there."""
        now = self._now
        now.voltages[...] = acting if acting.shape == now.voltages.shape else acting.reshape(now.voltages.shape)
        return now.joined, now.voltages

    def advance(self, operators: Operators, joined: Array, multiply: Multiply, halves: Array) -> tuple[Array, Array, Array, Array]:
        """Go on to the next state; output, tip displacement, and increment of J of the interval, as ``kernel.advance`` gives them,
        and the sum of squares of the blade's own states there weighted by ``halves`` (b,): its energy.
        """
        now, then, views = self._now, self._then, self._views
        _, output, tip, increment = advance(operators, joined, then.product, multiply, self.squares, views)
        self._now, self._then, self._views, self._next_views = then, now, self._next_views, views
        return output, tip, increment, weighted(np.square(then.energetic, out=self.squares), halves)

    def put(self, those: Any, state: Array) -> None:
        """Put some blades into other states (k, n), at rest otherwise."""
        those.lay(self._now.joined, 0.0)
        self.carry(those, state)

    def carry(self, those: Any, state: Array) -> None:
        """Put some blades into other states (k, n)."""
        those.lay(self._now.state, state)
        those.lay(self.squares, state[:, : self.squares.shape[-1]] ** 2)

    def of(self, those: Any) -> Array:
        """The states (k, n) of some blades; (n,) of a blade alone."""
        return self._now.state[those.at or ...]

    def load(self, joined: Any) -> None:
        """Go back to an earlier ``joined``."""
        self._now.joined[...] = np.asarray(joined)
        np.square(self._now.energetic, out=self.squares)

    @property
    def joined(self) -> Array:
        """A copy (…, s) of state, voltages and loads."""
        return self._now.joined.copy()


class Fresh:
    """The states of blades as tensors, of which each step makes new ones: gradients pass."""

    loads = weighted = None

    def __init__(self, count: int, operators: Operators, sizes: Sizes, arrays: Arrays) -> None:
        self._own, self.state = sizes[-1], arrays.zeros(count, operators.states)

    def join(self, acting: Any, loads: Any) -> tuple[Any, Any]:
        """[state, voltages, loads] (N, s), and the voltages."""
        return namespace(acting).concatenate([self.state, acting, loads], -1), acting

    def advance(self, operators: Operators, joined: Any, multiply: Multiply, halves: Any) -> tuple[Any, Any, Any, Any]:
        """As ``InPlace.advance``."""
        self.state, output, tip, increment = advance(operators, joined, multiply=multiply)
        return output, tip, increment, weighted(self.state[:, : self._own] ** 2, halves)

    def put(self, those: Any, state: Any) -> None:
        """Put some blades into other states."""
        self.state = those.put(self.state, state)

    carry = put

    def of(self, those: Any) -> Any:
        """The states (k, n) of some blades."""
        return those.take(self.state)

    def load(self, joined: Any) -> None:
        """Go back to an earlier ``joined``."""
        self.state = copied(joined)

    @property
    def joined(self) -> Any:
        """A copy (N, n) of the state."""
        return copied(self.state)

    def detach(self) -> None:
        """Cut the state from the graph that it came of."""
        self.state = self.state.detach()


def product_in_parts(rows: Array, matrix: Array, out: Array) -> Array:
    """Blocks of rows (…, size, k) times a matrix (…, k, l), each block in as many equal parts as make its products small."""
    size, each = rows.shape[-2], matrix.shape[-2] * matrix.shape[-1]
    parts = next((parts for parts in (1, 2, 4, 8) if size % parts == 0 and size // parts * each <= _SMALL), 1)
    if parts == 1:
        return np.matmul(rows, matrix, out)
    rows, seen = (array.reshape(*array.shape[:-2], parts, size // parts, -1) for array in (rows, out))
    np.matmul(rows, matrix if matrix.ndim == 2 else matrix[..., None, :, :], seen)
    return out


def batch_shape(count: int) -> tuple[int, int]:
    """(blocks, size) with size near ``_BLOCK`` where count has such a divisor."""
    size = next((size for size in range(min(count, _BLOCK), _BLOCK // 4, -1) if count % size == 0), count)
    return count // size, size
