"""Many layouts reduced to their first r modes together: what ``beamenv.plant.reduction`` does one blade at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.contributions import Contributions
from baselines.placement.model.layout_model import LayoutMatrices
from beamenv.blade.config import BladeConfig
from beamenv.plant.reduction import SAME_PATCH_REGULARISATION

Array = NDArray[np.float64]

GUARD_MODES = 13
"""Modes iterated beyond the r wanted ones: with these each iteration gains a factor of ten in the last wanted mode."""

ITERATIONS = 3


@dataclass(frozen=True, slots=True, eq=False)
class ReducedLayouts:
    """N blades (or one for all, where patches have no passive effect) in energy coordinates x = [ω η; η̇], as in ``Plant``."""

    dynamics: Array
    """A (N, 2r, 2r), 1/s."""
    natural_frequencies: Array
    """(N, r), rad/s."""
    input: Array
    """B (N, 2r, a), √J/s per V."""
    input_weight: Array
    """R (N, a, a), J/V²: effort_weight FᵀK⁻¹F."""
    output: Array
    """C (N, s, 2r), A per √J."""
    disturbance_input: Array
    """E (N, 2r, 2), √J/s per N/m."""


@dataclass(frozen=True, slots=True)
class Reduction:
    """How blades are reduced: fields of ``BladeConfig``."""

    modes: int
    damping_ratio: float
    gyroscopic: bool
    effort_weight: float

    @classmethod
    def of(cls, config: BladeConfig) -> Reduction:
        """As a configuration says."""
        return cls(config.modes, config.damping_ratio, config.gyroscopic, config.effort_weight)


def reduce_layouts(parts: Contributions, matrices: LayoutMatrices, reduction: Reduction) -> ReducedLayouts:
    """Reduce layouts to their first modes."""
    compliance = np.asarray(np.linalg.inv(matrices.stiffness), dtype=np.float64)
    omega, shapes = lowest_modes(parts.bare_frequencies, matrices, compliance, reduction.modes)
    return in_modes(parts, matrices, compliance, omega, shapes, reduction)


def in_modes(
    parts: Contributions, matrices: LayoutMatrices, compliance: Array, omega: Array, shapes: Array, reduction: Reduction
) -> ReducedLayouts:
    """Layouts in given mass-normalised modes, frequencies (N, r) and shapes (N, n, r); ``compliance`` is K⁻¹ (N, n, n)."""
    across = shapes.swapaxes(-1, -2)
    damping = 2.0 * reduction.damping_ratio * diagonal(omega)
    if reduction.gyroscopic:
        damping = damping + across @ matrices.gyroscopic @ shapes
    weight = matrices.forces.swapaxes(-1, -2) @ compliance @ matrices.forces
    return ReducedLayouts(
        dynamics=first_order(diagonal(omega), damping),
        natural_frequencies=omega,
        input=on_velocity_rows(across @ matrices.forces),
        input_weight=reduction.effort_weight * regularised(weight),
        output=on_velocity_rows(across @ matrices.charges.swapaxes(-1, -2)).swapaxes(-1, -2),
        disturbance_input=on_velocity_rows(across @ parts.line_load),
    )


def lowest_modes(bare_frequencies: Array, matrices: LayoutMatrices, compliance: Array, modes: int) -> tuple[Array, Array]:
    """Frequencies (N, r) and mass-normalised shapes (N, n, r) by subspace iteration (Bathe 1971) from the bare blade's modes."""
    size = min(modes + GUARD_MODES, len(bare_frequencies))
    scale = bare_frequencies[:size] ** 2
    step = compliance @ matrices.mass
    basis = step[..., :size] * scale
    for _ in range(ITERATIONS):
        basis = orthonormal(step @ basis, matrices.stiffness)
    inverse_squares, vectors = np.linalg.eigh(basis.swapaxes(-1, -2) @ matrices.mass @ basis)
    omega = np.ascontiguousarray(inverse_squares[..., : -modes - 1 : -1]) ** -0.5
    return omega, basis @ (vectors[..., : -modes - 1 : -1] * omega[..., None, :])


def orthonormal(basis: Array, stiffness: Array) -> Array:
    """The same subspace with basisᵀ K basis = I."""
    root = np.linalg.inv(np.linalg.cholesky(basis.swapaxes(-1, -2) @ stiffness @ basis))
    return basis @ root.swapaxes(-1, -2)


def first_order(frequency: Array, damping: Array) -> Array:
    """A = [[0, Ω], [−Ω, −D]] (…, 2r, 2r) in energy coordinates."""
    return np.concatenate(
        [
            np.concatenate([np.zeros_like(frequency), frequency], axis=-1),
            np.concatenate([-frequency, -np.broadcast_to(damping, frequency.shape)], axis=-1),
        ],
        axis=-2,
    )


def on_velocity_rows(modal: Array) -> Array:
    """[0; modal] (…, 2r, k)."""
    return np.concatenate([np.zeros_like(modal), modal], axis=-2)


def diagonal(values: Array) -> Array:
    """Diagonal matrices (…, r, r)."""
    return values[..., None] * np.eye(values.shape[-1])


def regularised(weight: Array) -> Array:
    """FᵀK⁻¹F with the share of its mean diagonal that ``reduction.stored_energy_weight`` adds, symmetric."""
    size = weight.shape[-1]
    mean = np.trace(weight, axis1=-2, axis2=-1) / size
    return 0.5 * (weight + weight.swapaxes(-1, -2)) + SAME_PATCH_REGULARISATION * mean[..., None, None] * np.eye(size)
