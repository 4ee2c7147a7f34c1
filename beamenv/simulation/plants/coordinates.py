"""The state of a blade as another blade, its design, has its own: by displacements and velocities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade

Array = NDArray[np.float64]


def seen_from(blade: Blade, design: Blade) -> Array | None:
    """(n, d): the state of a blade in a design blade's coordinates, by its displacements and velocities.

    With mode shapes Ψ on the same trial functions η_d = Ψ_dᵀ M_d Ψ η. None where the trial functions are not the same.
    """
    if blade.beam.space != design.beam.space:
        return None
    true = blade.true_modal
    return coordinates(true.mode_shapes / true.natural_frequencies, true.mode_shapes, design)


def coordinates(displacing: Array, moving: Array, design: Blade) -> Array:
    """(n, d) map of states whose halves move the trial functions' coefficients by ``displacing`` and ``moving`` (N, r)."""
    projection = design.modal.mode_shapes.T @ design.beam.matrices.mass
    displaced, moved = design.modal.natural_frequencies[:, None] * (projection @ displacing), projection @ moving
    d, r = displaced.shape
    whole = np.zeros((2 * d, 2 * r))
    whole[:d, :r], whole[d:, r:] = displaced, moved
    return whole.T
