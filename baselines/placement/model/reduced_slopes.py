"""How one reduced layout changes as its patches move: exact derivatives of what ``reduced_layouts`` gives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from baselines.placement.model.contributions import Contributions
from baselines.placement.model.layout_model import LayoutMatrices, MatrixSlopes
from baselines.placement.model.reduced_layouts import Reduction, layouts_in_modes
from beamenv.plant.reduction import ReducedBlades, acting_on_velocities, first_order, on_velocities, regularised

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class ReducedSlopes:
    """Derivatives by the p patches' positions, per m, of the fields of the same name of ``ReducedBlades``.

    The kept modes turn among themselves as the layout changes; that turn, which no trace sees and which is without bound where
    two frequencies meet, is left out: the coordinates stay mass-normalised and the frequency matrix symmetric instead of diagonal.
    """

    dynamics: Array
    """(p, 2r, 2r)."""
    input: Array
    """(p, 2r, a)."""
    input_weight: Array
    """(p, a, a)."""
    output: Array
    """(p, s, 2r)."""
    disturbance_input: Array
    """(p, 2r, 2)."""


def reduce_with_slopes(
    parts: Contributions, matrices: LayoutMatrices, slopes: MatrixSlopes, reduction: Reduction
) -> tuple[ReducedBlades, ReducedSlopes]:
    """One layout, reduced, and its derivatives in the same coordinates."""
    stiffness = matrices.stiffness[0]
    inverse_squares, vectors = eigh(matrices.mass[0], stiffness)
    omega = inverse_squares[::-1] ** -0.5
    shapes, kept = vectors[:, ::-1] * omega, slice(reduction.modes)
    compliance = np.linalg.inv(stiffness)
    reduced = layouts_in_modes(parts, matrices, compliance, omega[None, kept], shapes[None, :, kept], reduction)
    return reduced, reduced_slopes(parts, matrices, slopes, compliance, omega, shapes, reduction)


def reduced_slopes(
    parts: Contributions,
    matrices: LayoutMatrices,
    slopes: MatrixSlopes,
    compliance: Array,
    omega: Array,
    shapes: Array,
    reduction: Reduction,
) -> ReducedSlopes:
    """Derivatives from all N modes: frequencies (N,) and mass-normalised shapes (N, N)."""
    forces, kept = matrices.forces[0], shapes[:, : reduction.modes]
    turn, squares = shape_slopes(omega, reduction.modes, shapes.T @ slopes.stiffness @ kept, shapes.T @ slopes.mass @ kept)
    frequency = squares / np.add.outer(omega[: reduction.modes], omega[: reduction.modes])
    damping = 2.0 * reduction.damping_ratio * frequency
    across = turn.swapaxes(1, 2)
    if reduction.gyroscopic:
        change = across @ (shapes.T @ matrices.gyroscopic[0] @ kept)
        damping = damping + kept.T @ slopes.gyroscopic @ kept + change - change.swapaxes(1, 2)
    output = matrices.charges[0] @ shapes @ turn + slopes.charges @ kept
    return ReducedSlopes(
        dynamics=first_order(frequency, damping),
        input=acting_on_velocities(across @ (shapes.T @ forces) + kept.T @ slopes.forces),
        input_weight=reduction.effort_weight * weight_slopes(compliance @ forces, slopes),
        output=on_velocities(output),
        disturbance_input=acting_on_velocities(across @ (shapes.T @ parts.line_load)),
    )


def shape_slopes(omega: Array, modes: int, stiffness: Array, mass: Array) -> tuple[Array, Array]:
    """Kept shapes' derivatives in all N shapes (p, N, r), and that of their matrix of squared frequencies (p, r, r).

    ``stiffness`` and ``mass`` (p, N, r) are dK and dM between all shapes and the kept ones.
    """
    squares, kept = omega**2, omega[:modes] ** 2
    gap = kept - squares[modes:, None]
    turn = np.empty_like(stiffness)
    turn[:, :modes] = -0.5 * mass[:, :modes]
    turn[:, modes:] = (stiffness[:, modes:] - kept * mass[:, modes:]) / gap
    return turn, stiffness[:, :modes] - 0.5 * np.add.outer(kept, kept) * mass[:, :modes]


def weight_slopes(yielding: Array, slopes: MatrixSlopes) -> Array:
    """Derivatives (p, a, a) of the actuators' stored energy, regularised; ``yielding`` is K⁻¹F (N, a)."""
    if slopes.stored_energy is not None:
        return regularised(slopes.stored_energy)
    half = slopes.forces.swapaxes(1, 2) @ yielding
    return regularised(half + half.swapaxes(1, 2) - yielding.T @ slopes.stiffness @ yielding)
