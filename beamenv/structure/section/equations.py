"""The equations of a section's lines and beam strain, added up from elements and factorised: dense if they are few, else sparse."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve

from beamenv.structure.section.element_sums import ElementSums
from beamenv.structure.section.elements import RIGID
from beamenv.structure.section.lines import PER_LINE
from beamenv.structure.section.sparse_system import SparseFactors, SparseSystem

Array = NDArray[np.float64]

DENSE = 500
"""Most equations that are solved as a dense matrix; of more, as lines have few neighbours, sparse factors are six times quicker."""


def assembled(sums: ElementSums, section: int, bordered: Array) -> Array | SparseSystem:
    """One system of lines and beam strain from elements (K, 24 + 6, 24 + 6), and of hosts their whole."""
    size = len(sums.lines.solved) * PER_LINE + RIGID
    if size <= DENSE:
        return _dense(sums, section, bordered)
    hosts = sums.lines.hosts
    warping, side, beam = (each[section, hosts] for each in (sums.warping, sums.beam_strain, sums.beam))
    return SparseSystem.of(sums.lines, bordered, np.block([[warping, side], [side.swapaxes(-1, -2), beam]]))


def diagonal_of(system: Array | SparseSystem) -> Array:
    """(n,)."""
    return np.asarray(system.diagonal())


@dataclass(frozen=True, slots=True)
class Factors:
    """Of a system in its units, with rigid motion of its lines held."""

    dense: tuple[Array, NDArray[np.int32]] | None
    sparse: SparseFactors | None

    @classmethod
    def of(cls, system: Array | SparseSystem, scale: Array, held: Array) -> Factors:
        """``held`` (12 L, 6): averages of rigid motion, of which the squares are added to the energy."""
        if isinstance(system, SparseSystem):
            return cls(None, system.factors(scale, held))
        scaled = scale[:, None] * system * scale
        scaled[: len(held), : len(held)] += held @ held.T
        factors, pivots = lu_factor(scaled, check_finite=False)
        return cls((factors, pivots), None)

    def solve(self, right: Array) -> Array:
        """(n, c)."""
        if self.dense is not None:
            return np.asarray(lu_solve(self.dense, right, check_finite=False))
        assert self.sparse is not None
        return self.sparse.solve(right)


def _dense(sums: ElementSums, section: int, bordered: Array) -> Array:
    lines = sums.lines
    count, places = len(lines.solved), lines.places
    every = count + len(lines.faces)
    blocks, border = np.zeros((every, PER_LINE, every, PER_LINE)), np.zeros((every, PER_LINE, RIGID))
    rest = np.delete(np.arange(len(bordered)), lines.hosts)
    here, there = places[lines.of_elements[rest, 0]], places[lines.of_elements[rest, -1]]
    first, last, strain = slice(0, PER_LINE), slice(PER_LINE, 2 * PER_LINE), slice(2 * PER_LINE, None)
    for rows, row in ((here, first), (there, last)):
        for columns, column in ((here, first), (there, last)):
            blocks[rows, :, columns] += bordered[rest, row, column]
        border[rows] += bordered[rest, row, strain]
    for host in lines.hosts:
        own = places[lines.of_elements[host]]
        shape = (len(own), PER_LINE)
        blocks[own[:, None], :, own] += sums.warping[section, host].reshape(*shape, *shape).swapaxes(1, 2)
        border[own] += sums.beam_strain[section, host].reshape(*shape, RIGID)
    size = count * PER_LINE
    square, side = blocks.reshape(every * PER_LINE, -1), border.reshape(-1, RIGID)
    whole = np.zeros((size + RIGID, size + RIGID))
    whole[:size, :size], whole[:size, size:] = square[:size, :size], side[:size]
    if len(lines.faces):
        follow = lines.follow
        crossed = square[:size, size:] @ follow
        whole[:size, :size] += crossed + crossed.T + follow.T @ square[size:, size:] @ follow
        whole[:size, size:] += follow.T @ side[size:]
    whole[size:, :size] = whole[:size, size:].T
    whole[size:, size:] = bordered[:, strain, strain].sum(axis=0)
    return whole
