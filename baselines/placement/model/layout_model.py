"""Layouts as matrices: what many blades, each with its patches elsewhere, are made of, by a few products each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.contributions import Contributions
from baselines.placement.model.intervals import Intervals
from baselines.placement.model.triangles import skew_from, symmetric_from

Array = NDArray[np.float64]
Matrices = TypeVar("Matrices", "LayoutMatrices", "MatrixSlopes")


@dataclass(frozen=True, slots=True, eq=False)
class LayoutMatrices:
    """Full-order blades in the coordinates of ``Contributions``; without passive effect the first three have one row for all."""

    stiffness: Array
    """K (N, n, n)."""
    mass: Array
    """M (N, n, n)."""
    gyroscopic: Array
    """G (N, n, n), at the speed."""
    forces: Array
    """(N, n, a): per volt of every actuator."""
    charges: Array
    """(N, s, n): C per coordinate of every sensor."""
    stored_energy: Array | None
    """(N, a, a), J/V²: twice what the actuators store in the blade at rest; None: FᵀK⁻¹F."""


def layout_matrices(parts: Contributions, cut: Intervals, passive: bool) -> LayoutMatrices:
    """Blades with patches that cut them so."""
    n = len(parts.bare_frequencies)
    stiffness, mass, gyroscopic = np.eye(n)[None], np.diag(parts.bare_frequencies**-2.0)[None], parts.bare_gyroscopic[None]
    if passive:
        share = cut.share()
        both = np.concatenate([share, cut.pulled_share(parts.tension)], axis=1)
        stiffness = stiffness + symmetric_from(both @ parts.stiffness, n)
        mass = mass + symmetric_from(share @ parts.mass, n)
        gyroscopic = gyroscopic + skew_from(share @ parts.gyroscopic, n)
    top, below = cut.patches.force_shares()
    return LayoutMatrices(
        stiffness=stiffness,
        mass=mass,
        gyroscopic=gyroscopic,
        forces=along(top, parts.actuator_force).swapaxes(1, 2),
        charges=along(below, parts.sensor_force),
        stored_energy=stored(top, parts.actuator_energy),
    )


def ganged(matrices: Matrices) -> Matrices:
    """With one voltage for all actuators, their forces are one."""
    stored = matrices.stored_energy
    whole = None if stored is None else stored.sum(axis=(-2, -1), keepdims=True)
    return replace(matrices, forces=matrices.forces.sum(axis=-1, keepdims=True), stored_energy=whole)


def along(shares: Array, series: Array) -> Array:
    """Force vectors (…, n) from shares (…, 2, k) of the two series (2, k, n)."""
    return np.asarray(shares.reshape(*shares.shape[:-2], series.shape[0] * series.shape[1]) @ series.reshape(-1, series.shape[-1]))


def stored(shares: Array, series: Array | None) -> Array | None:
    """Diagonal matrices (…, a, a) from shares (…, a, 2, k) of the two series (2, k): patches of one side do not overlap."""
    return None if series is None else np.eye(shares.shape[-3]) * np.tensordot(shares, series, 2)[..., None]


@dataclass(frozen=True, slots=True, eq=False)
class MatrixSlopes:
    """Derivatives of one layout's matrices by the positions of p of its patches, per m."""

    stiffness: Array
    mass: Array
    gyroscopic: Array
    """(p, n, n) each."""
    forces: Array
    """(p, n, a)."""
    charges: Array
    """(p, s, n)."""
    stored_energy: Array | None
    """(p, a, a)."""


def matrix_slopes(parts: Contributions, cut: Intervals, passive: bool, moved: slice = slice(None)) -> MatrixSlopes:
    """Derivatives of one layout; by the positions of all patches, actuators first, or of those ``moved``."""
    n = len(parts.bare_frequencies)
    at_edges = cut.patches.slopes()
    top, below = (both_edges(each[0])[moved] for each in cut.patches.force_share_slopes(at_edges))
    stiffness = mass = gyroscopic = np.zeros((len(top), n, n))
    if passive:
        share = both_edges(cut.share_slopes(at_edges)[0])[moved]
        both = np.concatenate([share, both_edges(cut.pulled_share_slopes(parts.tension, at_edges)[0])[moved]], axis=1)
        stiffness = symmetric_from(both @ parts.stiffness, n)
        mass, gyroscopic = symmetric_from(share @ parts.mass, n), skew_from(share @ parts.gyroscopic, n)
    return MatrixSlopes(
        stiffness=stiffness,
        mass=mass,
        gyroscopic=gyroscopic,
        forces=along(top, parts.actuator_force).swapaxes(1, 2),
        charges=along(below, parts.sensor_force),
        stored_energy=stored(top, parts.actuator_energy),
    )


def both_edges(by_edge: Array) -> Array:
    """Derivatives (patches, …) by patches that move whole, from those by their starts and their ends (2 patches, …)."""
    start, end = np.split(by_edge, 2)
    return np.asarray(start + end)
