"""The state of a blade as another blade, its design, has its own: by displacements and velocities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.plant.reduction import ModalModel

Array = NDArray[np.float64]


def seen_from(blade: Blade, design: Blade) -> Array | None:
    """(n, d): the true state of a blade in a design blade's coordinates, by its displacements and velocities.

    With mode shapes Ψ on the same trial functions η_d = Ψ_dᵀ M_d Ψ η; what filters and amplifiers hold is not the blade's. None
    where the trial functions are not the same.
    """
    if blade.beam.space != design.beam.space:
        return None
    return widened(between(blade.true_modal, design), len(blade.truth.A))


def between(modal: ModalModel, design: Blade) -> Array:
    """(2r, d): states of r modes in the coordinates of a design blade on the same trial functions."""
    return coordinates(modal.mode_shapes / modal.natural_frequencies, modal.mode_shapes, design)


def widened(view: Array, states: int) -> Array:
    """(…, n, d): a view (…, 2r, d) of the first 2r of n ``states``, which sees nothing of the others."""
    unseen = np.zeros((*view.shape[:-2], states - view.shape[-2], view.shape[-1]))
    return np.concatenate([view, unseen], axis=-2)


def coordinates(displacing: Array, moving: Array, design: Blade) -> Array:
    """(n, d) map of states whose halves move the trial functions' coefficients by ``displacing`` and ``moving`` (N, r)."""
    projection = design.modal.mode_shapes.T @ design.beam.at(design.config.speed).mass
    displaced, moved = design.modal.natural_frequencies[:, None] * (projection @ displacing), projection @ moving
    d, r = displaced.shape
    whole = np.zeros((2 * d, 2 * r))
    whole[:d, :r], whole[d:, r:] = displaced, moved
    return whole.T
