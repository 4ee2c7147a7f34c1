"""Which motions couple, and through what, read off the assembled matrices (Tables 2.1 and 2.2)."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import RotatingBeam

Array = NDArray[np.float64]

KINDS = ("stiffness", "gyroscopic", "centrifugal", "rotary_inertia")
"""K_e, G₁, K_Ω and M off the diagonal."""

VANISHING = 1e-10
"""A block whose largest entry is below this share of the two fields' own entries is round-off."""


def coupled_fields(beam: RotatingBeam) -> dict[tuple[str, str], frozenset[str]]:
    """The kinds of coupling between each pair of fields of a blade; a beam with rigid shear has fewer fields."""
    matrices, names = beam.matrices, beam.space.fields
    strengths = {
        "stiffness": block_strengths(matrices.elastic_stiffness, matrices.elastic_stiffness, len(names)),
        "gyroscopic": block_strengths(matrices.gyroscopic, matrices.mass, len(names)),
        "centrifugal": block_strengths(matrices.spin_stiffness, matrices.mass, len(names)),
        "rotary_inertia": block_strengths(matrices.mass, matrices.mass, len(names)),
    }
    return {
        (names[i], names[j]): frozenset(kind for kind in KINDS if strengths[kind][i, j] > VANISHING)
        for i, j in combinations(range(len(names)), 2)
    }


def block_strengths(matrix: Array, scale: Array, fields: int) -> Array:
    """(fields, fields): the largest entry of each block over √(own · own) of the positive definite ``scale``."""
    own = np.sqrt(np.diag(scale))
    size = len(own) // fields
    blocks = np.abs(matrix / np.outer(own, own)).reshape(fields, size, fields, size)
    return np.asarray(blocks.max(axis=(1, 3)))


def subsystems(couplings: dict[tuple[str, str], frozenset[str]]) -> list[frozenset[str]]:
    """The sets of fields that move together, whatever couples them."""
    groups = [frozenset([name]) for name in dict.fromkeys(name for pair in couplings for name in pair)]
    for (first, second), kinds in couplings.items():
        if kinds:
            joined = frozenset().union(*(group for group in groups if first in group or second in group))
            groups = [group for group in groups if not group & joined] + [joined]
    return groups
