"""The equations of a section's lines and beam strain, added up from elements and factorised: dense if they are few, else sparse."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse import block_array, coo_array, csc_array, eye_array
from scipy.sparse.linalg import SuperLU, splu

from beamenv.structure.section.element_sums import ElementSums
from beamenv.structure.section.elements import RIGID
from beamenv.structure.section.lines import PER_LINE

Array = NDArray[np.float64]

DENSE = 500
"""Most equations that are solved as a dense matrix; of more, as lines have few neighbours, sparse factors are six times quicker."""

PIVOT = 0.01
"""Of the largest in its column: a diagonal entry no smaller than that is a pivot. What digits are lost, corrections bring back."""


def assembled(sums: ElementSums, section: int, bordered: Array) -> Array | csc_array:
    """One system of lines and beam strain from elements (K, 24 + 6, 24 + 6), and of hosts their whole."""
    size = len(sums.lines.solved) * PER_LINE + RIGID
    return _dense(sums, section, bordered) if size <= DENSE else _sparse(sums, section, bordered)


def diagonal_of(system: Array | csc_array) -> Array:
    """(n,)."""
    return np.asarray(system.diagonal())


@dataclass(frozen=True, slots=True)
class Factors:
    """Of a system in its units, with rigid motion of its lines held."""

    dense: tuple[Array, NDArray[np.int32]] | None
    sparse: SuperLU | None

    @classmethod
    def of(cls, system: Array | csc_array, scale: Array, held: Array) -> Factors:
        """``held`` (12 L, 6): averages of rigid motion, of which the squares are added to the energy."""
        if isinstance(system, np.ndarray):
            scaled = scale[:, None] * system * scale
            scaled[: len(held), : len(held)] += held @ held.T
            factors, pivots = lu_factor(scaled, check_finite=False)
            return cls((factors, pivots), None)
        units = eye_array(len(scale), format="csr").multiply(scale)
        average = csc_array(np.vstack([held, np.zeros((RIGID, RIGID))]))
        # [[K, H], [Hᵀ, −1]] leaves K + H Hᵀ for the first unknowns, and K sparse
        whole = block_array([[units @ system @ units, average], [average.T, -eye_array(RIGID)]], format="csc")
        return cls(None, splu(whole, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=PIVOT))

    def solve(self, right: Array) -> Array:
        """(n, c)."""
        if self.dense is not None:
            return np.asarray(lu_solve(self.dense, right, check_finite=False))
        assert self.sparse is not None
        return np.asarray(self.sparse.solve(np.vstack([right, np.zeros((RIGID, right.shape[1]))]))[:-RIGID])


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


def _sparse(sums: ElementSums, section: int, bordered: Array) -> csc_array:
    lines = sums.lines
    count, places, joints = len(lines.solved), lines.places, len(lines.faces)
    every = (count + joints) * PER_LINE
    rest = np.delete(np.arange(len(bordered)), lines.hosts)
    strains = np.broadcast_to(every + np.arange(RIGID), (len(rest), RIGID))
    own = np.concatenate([_displacements(places[lines.of_elements[rest][:, [0, -1]]]), strains], axis=1)
    parts = [_entries(own, bordered[rest])]
    if len(lines.hosts):
        strains = np.broadcast_to(every + np.arange(RIGID), (len(lines.hosts), RIGID))
        own = np.concatenate([_displacements(places[lines.of_elements[lines.hosts]]), strains], axis=1)
        warping, side, beam = (each[section, lines.hosts] for each in (sums.warping, sums.beam_strain, sums.beam))
        parts.append(_entries(own, np.block([[warping, side], [side.swapaxes(-1, -2), beam]])))
    rows, columns, values = (np.concatenate(each) for each in zip(*parts, strict=True))
    whole = csc_array(coo_array((values, (rows, columns)), shape=(every + RIGID,) * 2))
    if not joints:
        return whole
    kept = eye_array(count * PER_LINE)
    onto: Any = block_array([[kept, None], [csc_array(lines.follow), None], [None, eye_array(RIGID)]], format="csc")
    return csc_array(onto.T @ whole @ onto)


def _displacements(lines: NDArray[np.intp]) -> NDArray[np.intp]:
    """(E, 12 l): where the displacements of E times l lines stand."""
    return (lines[..., None] * PER_LINE + np.arange(PER_LINE)).reshape(len(lines), -1)


def _entries(own: NDArray[np.intp], matrices: Array) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Rows, columns and values of element matrices (E, n, n) that stand at ``own`` (E, n)."""
    shape = matrices.shape
    rows, columns = np.broadcast_to(own[:, :, None], shape), np.broadcast_to(own[:, None, :], shape)
    return rows.ravel(), columns.ravel(), matrices.ravel()
