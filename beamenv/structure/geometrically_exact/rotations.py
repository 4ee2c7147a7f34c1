"""Finite rotations as vectors c (axis times angle), stations leading: R = exp(ĉ)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CROSS = np.zeros((3, 9))
_CROSS[[0, 0, 1, 1, 2, 2], [7, 5, 2, 6, 3, 1]] = 1.0, -1.0, 1.0, -1.0, 1.0, -1.0

_SMALL = 1e-4
"""rad: below, series are exact to round-off."""


def hat(vector: Array) -> Array:
    """v̂ (…, 3, 3) with v̂ a = v × a."""
    return (vector @ _CROSS).reshape(*vector.shape[:-1], 3, 3)


def about_span(angle: Array) -> Array:
    """(…, 3, 3): turns about z, rad."""
    return rotation(np.stack([np.zeros_like(angle), np.zeros_like(angle), angle], axis=-1))


def _coefficients(vector: Array) -> tuple[Array, Array, Array]:
    """Sin a/a, (1 − cos a)/a² and (a − sin a)/a³ of the angle a, (…, 1, 1)."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    square = angle**2
    safe = np.where(angle < _SMALL, 1.0, angle)
    return (
        np.where(angle < _SMALL, 1.0 - square / 6.0, np.sin(safe) / safe),
        np.where(angle < _SMALL, 0.5 - square / 24.0, (1.0 - np.cos(safe)) / safe**2),
        np.where(angle < _SMALL, 1.0 / 6.0 - square / 120.0, (safe - np.sin(safe)) / safe**3),
    )


def rotation(vector: Array) -> Array:
    """exp(ĉ) (…, 3, 3); Rodrigues' formula."""
    first, second, _ = _coefficients(vector)
    turned = hat(vector)
    return np.eye(3) + first * turned + second * turned @ turned


def rotation_vector(matrix: Array) -> Array:
    """C (…, 3) of rotations by less than π."""
    skew = 0.5 * (matrix - np.swapaxes(matrix, -1, -2))
    axis = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    sine = np.linalg.norm(axis, axis=-1)
    angle = np.arctan2(sine, 0.5 * (np.trace(matrix, axis1=-2, axis2=-1) - 1.0))
    factor = np.where(sine < _SMALL, 1.0 + sine**2 / 6.0, angle / np.where(sine < _SMALL, 1.0, sine))
    return np.asarray(factor[..., None] * axis)


def curvature(vector: Array, slope: Array) -> Array:
    """(…, 3): axial vector of RᵀR′ from c and c′."""
    _, second, third = _coefficients(vector)
    turned = hat(vector)
    onto = np.eye(3) - second * turned + third * turned @ turned
    return np.asarray((onto @ slope[..., None])[..., 0])
