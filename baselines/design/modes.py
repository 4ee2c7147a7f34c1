"""Modes of sampled systems, in real numbers: what one instant makes of each is a multiplication by a complex number."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array

CONDITION = 1e6
"""Largest condition of T, columns of length 1, up to which modes stand for states: rounding is 1e-10 of the states at most then.
The filters of the default blade have 3e3 to 1.2e4; where eigenvectors are parallel it is 1e8 and more."""

ALIKE = 1e-15
"""Eigenvalues that differ by no more count as equal: over an episode of 2000 instants that is 2e-12."""


class Modes(NamedTuple):
    """Of A (s, s): A = T Λ T⁻¹, with c ≥ s numbers, real and imaginary part of each mode next to each other."""

    eigenvalues: NDArray[np.complex128]
    """(c / 2,)."""
    states: Array
    """T (s, c)."""
    of_states: Array
    """T⁻¹ (c, s): T T⁻¹ = I."""


def modes_of(matrices: Sequence[Array]) -> list[Modes] | None:
    """Of each; None where any has none that are well conditioned."""
    found: dict[bytes, Modes | None] = {}
    for A in matrices:
        key = A.tobytes()
        if key not in found:
            found[key] = _modes(A)
        if found[key] is None:
            return None
    return [each for A in matrices if (each := found[A.tobytes()]) is not None]


def common_modes(matrices: Sequence[Array]) -> list[Modes] | None:
    """The same modes for all; None where they are not well conditioned, or matrices differ by more than rounding."""
    first = matrices[0]
    if not all(A.shape == first.shape and np.abs(A - first).max() <= 1e-13 * np.abs(first).max() for A in matrices):
        return None
    modes = _modes(first)
    return None if modes is None else [modes] * len(matrices)


def _modes(A: Array) -> Modes | None:
    """A pair of conjugates is one number; so are two real eigenvalues that are equal; one alone has a zero beside it."""
    eigenvalues, vectors = np.linalg.eig(A)
    alone = sorted(np.flatnonzero(eigenvalues.imag == 0.0), key=lambda k: float(eigenvalues[k].real))
    turning = np.flatnonzero(eigenvalues.imag > 0.0)
    chosen, T = [*eigenvalues[turning]], np.zeros((len(A), 2 * (len(turning) + len(alone))))
    T[:, : 2 * len(turning)] = np.stack([vectors[:, turning].real, -vectors[:, turning].imag], axis=-1).reshape(len(A), -1)
    while alone:
        k, first = alone.pop(0), 2 * len(chosen)
        T[:, first] = vectors[:, k].real
        if alone and abs(eigenvalues[alone[0]] - eigenvalues[k]) <= ALIKE:
            T[:, first + 1] = vectors[:, alone.pop(0)].real
        chosen.append(eigenvalues[k])
    T = T[:, : 2 * len(chosen)]
    own = T.any(axis=0)
    if not np.linalg.cond(T[:, own]) <= CONDITION:
        return None
    inverse = np.zeros(T.shape[::-1])
    inverse[own] = np.linalg.inv(T[:, own])
    return Modes(np.array(chosen, dtype=np.complex128), T, inverse)
