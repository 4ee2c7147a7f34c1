"""Systems of many lines, sparse: where elements' entries stand is worked out once for all sections of one topology."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_diag, csc_array, csr_array, eye_array
from scipy.sparse.linalg import SuperLU, splu

from beamenv.structure.section.elements import RIGID
from beamenv.structure.section.lines import PER_LINE, Lines

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

PIVOT = 0.01
"""Of the largest in its column: a diagonal entry no smaller than that is a pivot. What digits are lost, corrections bring back."""

TOPOLOGIES = 16
"""As many are remembered."""


@dataclass(frozen=True, slots=True, eq=False)
class Pattern:
    """Where the entries of a system K of n unknowns are, of lines and beam strain, and those of [[K, H], [Hᵀ, −1]]."""

    rows: Indices
    columns: Indices
    """(e,): of K."""
    diagonal: Indices
    """(n,): which of them are on its diagonal."""
    adding: csr_array
    """(e, all): adds up K's entries from those of elements, joints taken for the lines that they follow."""
    order: Indices
    """Which of K's entries, H's, Hᵀ's and the diagonal's is next, column by column, the unknowns being reordered."""
    indices: NDArray[np.int32]
    starts: NDArray[np.int32]
    """As a ``csc_array`` has them."""
    places: Indices
    """(n + 6,): where each unknown stands after reordering."""

    def matrix(self, entries: Array) -> csc_array:
        """[[K, H], [Hᵀ, −1]] of entries in the order of K, H, Hᵀ and the diagonal."""
        size = len(self.places)
        return csc_array((entries[self.order], self.indices, self.starts), shape=(size, size))

    def reordered(self, right: Array) -> Array:
        """(n + 6, c) of (n, c)."""
        whole = np.empty((len(self.places), right.shape[1]))
        whole[self.places[:-RIGID]], whole[self.places[-RIGID:]] = right, 0.0
        return whole


@dataclass(frozen=True, slots=True, eq=False)
class SparseSystem:
    """One system by the entries of its pattern."""

    pattern: Pattern
    entries: Array

    @classmethod
    def of(cls, lines: Lines, elements: Array, hosts: Array) -> SparseSystem:
        """From elements (K, 30, 30) that have no joints and the whole of those that have (H, n, n)."""
        pattern = pattern_of(lines)
        rest = np.delete(elements, lines.hosts, axis=0)
        return cls(pattern, np.asarray(pattern.adding @ np.concatenate([rest.ravel(), hosts.ravel()])))

    def diagonal(self) -> Array:
        """(n,)."""
        return np.asarray(self.entries[self.pattern.diagonal])

    def factors(self, scale: Array, held: Array) -> SparseFactors:
        """In units ``scale`` (n,), with rigid motion ``held`` (12 L, 6): [[K, H], [Hᵀ, −1]] leaves K + H Hᵀ, and K sparse."""
        pattern = self.pattern
        scaled = self.entries * scale[pattern.rows] * scale[pattern.columns]
        matrix = pattern.matrix(np.concatenate([scaled, held.ravel(), held.ravel(), np.full(RIGID, -1.0)]))
        return SparseFactors(pattern, _factorised(matrix, "NATURAL"))


@dataclass(frozen=True, slots=True, eq=False)
class SparseFactors:
    """Of one system."""

    pattern: Pattern
    factors: SuperLU

    def solve(self, right: Array) -> Array:
        """(n, c)."""
        return np.asarray(self.factors.solve(self.pattern.reordered(right))[self.pattern.places[:-RIGID]])


def _factorised(matrix: csc_array, order: str) -> SuperLU:
    return splu(matrix, permc_spec=order, diag_pivot_thresh=PIVOT, options={"SymmetricMode": True})


def pattern_of(lines: Lines) -> Pattern:
    """That of a topology, remembered."""
    return _pattern(_Key(lines))


class _Key:
    """Lines by what they are, not by which object."""

    def __init__(self, lines: Lines) -> None:
        self.lines = lines
        arrays = lines.of_elements, lines.hosts, lines.faces, lines.shares
        self._content = lines.between, lines.free, tuple((each.shape, each.tobytes()) for each in arrays)

    def __hash__(self) -> int:
        return hash(self._content)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self._content == other._content


@lru_cache(maxsize=TOPOLOGIES)
def _pattern(key: _Key) -> Pattern:
    lines = key.lines
    count = len(lines.solved) * PER_LINE
    size, entry = count + RIGID, _entries(lines)
    which, row, column, weight = _onto(lines, *entry)
    known, place = np.unique(column * size + row, return_inverse=True)
    adding = csr_array((weight, (place.ravel(), which)), shape=(len(known), len(entry[0])))
    columns, rows = np.divmod(known, size)
    border, beside = np.divmod(np.arange(count * RIGID), RIGID)
    last = size + np.arange(RIGID)
    every = np.concatenate([rows, border, size + beside, last]), np.concatenate([columns, size + beside, border, last])
    places = _fewest(every, size + RIGID)
    placed = places[every[0]], places[every[1]]
    order = np.lexsort(placed)
    starts = np.searchsorted(placed[1][order], np.arange(size + RIGID + 1))
    indices, diagonal = placed[0][order].astype(np.int32), np.flatnonzero(rows == columns)
    return Pattern(rows, columns, diagonal, adding, order, indices, starts.astype(np.int32), places)


def _entries(lines: Lines) -> tuple[Indices, Indices]:
    """Rows and columns of the entries of elements, those that have joints last; displacements of joints behind all others."""
    places, strains = lines.places, (len(lines.solved) + len(lines.faces)) * PER_LINE + np.arange(RIGID)
    rest = np.delete(np.arange(len(lines.of_elements)), lines.hosts)
    rows, columns = [], []
    for own in (places[lines.of_elements[rest][:, [0, -1]]], places[lines.of_elements[lines.hosts]]):
        moved = (own[..., None] * PER_LINE + np.arange(PER_LINE)).reshape(len(own), own.shape[1] * PER_LINE)
        whole = np.concatenate([moved, np.broadcast_to(strains, (len(own), RIGID))], axis=1)
        shape = (len(own), whole.shape[1], whole.shape[1])
        rows.append(np.broadcast_to(whole[:, :, None], shape).ravel())
        columns.append(np.broadcast_to(whole[:, None, :], shape).ravel())
    return np.concatenate(rows), np.concatenate(columns)


def _onto(lines: Lines, rows: Indices, columns: Indices) -> tuple[Indices, Indices, Indices, Array]:
    """Entries, and with what weight they stand in which rows and columns, those of joints in those of the lines they follow."""
    kept = eye_array(len(lines.solved) * PER_LINE, format="csr")
    onto = block_diag([kept, eye_array(RIGID)], format="csr")
    if len(lines.faces):
        strains = block_diag([csr_array((0, kept.shape[1])), eye_array(RIGID)], format="csr")
        follow = csr_array(np.hstack([lines.follow, np.zeros((len(lines.faces) * PER_LINE, RIGID))]))
        onto = csr_array(np.vstack([onto[: kept.shape[0]].toarray(), follow.toarray(), strains.toarray()]))
    counts, starts = np.diff(onto.indptr), onto.indptr
    pairs = counts[rows] * counts[columns]
    entry = np.repeat(np.arange(len(rows)), pairs)
    within = np.arange(len(entry)) - np.repeat(np.cumsum(pairs) - pairs, pairs)
    left, right = np.divmod(within, counts[columns][entry])
    left, right = starts[rows[entry]] + left, starts[columns[entry]] + right
    found = onto.indices.astype(np.intp)
    return entry, found[left], found[right], np.asarray(onto.data[left] * onto.data[right])


def _fewest(entries: tuple[Indices, Indices], size: int) -> Indices:
    """(size,): the order of unknowns in which factors have few entries, by minimum degree; of the pattern alone."""
    values = np.where(entries[0] == entries[1], 1.0, 1e-6)
    return _factorised(csc_array((values, entries), shape=(size, size)), "MMD_AT_PLUS_A").perm_c.astype(np.intp)
