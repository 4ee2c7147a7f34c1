"""Many layouts' first r modes together, in which ``beamenv.plant.reduction`` reduces them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.contributions import Contributions
from baselines.placement.model.layout_model import LayoutMatrices
from beamenv.blade.config import BladeConfig
from beamenv.plant.reduction import ModalModel, ReducedBlades, in_modes

Array = NDArray[np.float64]

GUARD_MODES = 13
"""Modes iterated beyond the r wanted ones: with these each iteration gains a factor of ten in the last wanted mode."""

ITERATIONS = 3


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


def reduce_layouts(parts: Contributions, matrices: LayoutMatrices, reduction: Reduction) -> ReducedBlades:
    """Layouts reduced to their first modes: N blades, or one for all where patches have no passive effect."""
    compliance = np.asarray(np.linalg.inv(matrices.stiffness), dtype=np.float64)
    omega, shapes = lowest_modes(parts.bare_frequencies, matrices, compliance, reduction.modes)
    return layouts_in_modes(parts, matrices, compliance, omega, shapes, reduction)


def layouts_in_modes(
    parts: Contributions, matrices: LayoutMatrices, compliance: Array, omega: Array, shapes: Array, reduction: Reduction
) -> ReducedBlades:
    """Layouts in given mass-normalised modes, frequencies (N, r) and shapes (N, n, r); ``compliance`` is K⁻¹ (N, n, n)."""
    forces, across = matrices.forces, shapes.swapaxes(-1, -2)
    size, stored = omega.shape[-1], matrices.stored_energy
    if stored is None:
        stored = forces.swapaxes(-1, -2) @ compliance @ forces
    coupling = across @ matrices.gyroscopic @ shapes if reduction.gyroscopic else np.zeros((1, size, size))
    return in_modes(
        ModalModel(omega, shapes, coupling),
        forces=forces,
        charges=matrices.charges,
        line_load=parts.line_load,
        stored_energy=stored,
        damping_ratio=reduction.damping_ratio,
        effort_weight=reduction.effort_weight,
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
