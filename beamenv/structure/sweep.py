"""Frequencies of many blades at many speeds: matrices assembled once per blade, eigenproblems solved in stacks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.configuration import Count, Refused, checked
from beamenv.structure.assembly import BeamMatrices
from beamenv.structure.beam import RotatingBeam
from beamenv.structure.modes import critical_speed, diverged_frequencies, reduced, stable_frequencies

Array = NDArray[np.float64]

STACK = 64
"""Eigenproblems solved in one call: beyond this a larger stack only takes more memory."""


def frequency_sweep(
    beams: RotatingBeam | Sequence[RotatingBeam],
    speeds: ArrayLike,
    count: int = 6,
    motions: tuple[str, ...] | None = None,
    gyroscopic: bool = True,
) -> Array:
    """Natural frequencies (beams, speeds, count), rad/s, ascending; (speeds, count) for one beam alone.

    ``speeds`` (S,) in rad/s; ``motions`` as in ``RotatingBeam.natural_frequencies``, whose results these are. Modes that have lost
    their stiffness are reported at zero. Raises ``ValueError`` for a speed that is negative or not finite, or for too high a count.
    """
    omega = np.atleast_1d(np.asarray(speeds, dtype=float))
    if omega.ndim != 1 or not np.all(np.isfinite(omega) & (omega >= 0.0)):
        raise Refused("speeds", speeds, "zero or positive numbers of rad/s in one row")
    if isinstance(beams, RotatingBeam):
        return _sweep(beams, omega, count, motions, gyroscopic)
    return np.stack([_sweep(beam, omega, count, motions, gyroscopic) for beam in beams])


def _sweep(beam: RotatingBeam, speeds: Array, count: int, motions: tuple[str, ...] | None, gyroscopic: bool) -> Array:
    columns = beam.space.columns(motions)
    count = checked("count", count, Count(1, len(columns)))
    matrices = beam.matrices if motions is None else beam.matrices.restricted(columns)
    elastic, spin, coupling = mass_reduced(matrices)
    critical = critical_speed(matrices.elastic_stiffness, matrices.spin_stiffness)
    frequencies = np.empty((len(speeds), count))
    groups = (np.flatnonzero(speeds < critical), np.flatnonzero(speeds >= critical))
    for diverged, group in enumerate(groups):
        for start in range(0, len(group), STACK):
            picked = group[start : start + STACK]
            omega = speeds[picked, None, None]
            frequencies[picked] = _stack(elastic + omega**2 * spin, omega * coupling, gyroscopic, bool(diverged))[:, :count]
    return frequencies


def mass_reduced(matrices: BeamMatrices) -> tuple[Array, Array, Array]:
    """K_e, K_Ω, G₁ (N, N) in coordinates in which M is the identity."""
    root = np.asarray(np.linalg.cholesky(matrices.mass), dtype=np.float64)
    return (
        reduced(root, matrices.elastic_stiffness),
        reduced(root, matrices.spin_stiffness),
        reduced(root, matrices.gyroscopic),
    )


def _stack(stiffness: Array, gyroscopic: Array, coupled: bool, diverged: bool) -> Array:
    if not (coupled and np.any(gyroscopic)):
        symmetric = 0.5 * (stiffness + np.swapaxes(stiffness, -1, -2))
        return np.sqrt(np.maximum(np.linalg.eigvalsh(symmetric), 0.0))
    return diverged_frequencies(stiffness, gyroscopic) if diverged else stable_frequencies(stiffness, gyroscopic)
