"""The state of a blade as another blade, its design, has its own: by displacements and velocities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import build_beam
from beamenv.blade.config import BladeConfig
from beamenv.plant.reduction import truncate
from beamenv.structure import RotatingBeam

Array = NDArray[np.float64]


def seen_from(config: BladeConfig, beam: RotatingBeam, design: BladeConfig) -> Array | None:
    """(n, d): the state of a blade in a design blade's coordinates, by its displacements and velocities.

    With mode shapes Ψ on the same trial functions η_d = Ψ_dᵀ M_d Ψ η. None where the trial functions are not the same.
    """
    other = build_beam(design)
    if beam.space != other.space:
        return None
    true, modal = (truncate(blade, of.speed, of.modes, of.gyroscopic) for blade, of in ((beam, config), (other, design)))
    displacing = true.mode_shapes / true.natural_frequencies
    return coordinates(displacing, true.mode_shapes, other, modal.mode_shapes, modal.natural_frequencies)


def coordinates(displacing: Array, moving: Array, design: RotatingBeam, shapes: Array, frequencies: Array) -> Array:
    """(n, d) map of states whose halves move the trial functions' coefficients by ``displacing`` and ``moving`` (N, r)."""
    projection = shapes.T @ design.matrices.mass
    displaced, moved = frequencies[:, None] * (projection @ displacing), projection @ moving
    still = np.zeros_like(displaced)
    return np.asarray(np.block([[displaced, still], [still, moved]]).T)
