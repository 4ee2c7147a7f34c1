"""Frequencies of many blades at many speeds: matrices assembled once per blade, eigenproblems solved in stacks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.configuration import Count, Flag, Instance, Refused, checked
from beamenv.configuration.arrays import real_numbers
from beamenv.structure.assembly import BeamMatrices
from beamenv.structure.beam import RotatingBeam
from beamenv.structure.geometrically_exact.exact_beam import ExactBeam
from beamenv.structure.geometrically_exact.operating_point import SteadyState
from beamenv.structure.geometrically_exact.sections_along import between
from beamenv.structure.modes import diverged_frequencies, reduced, stable_frequencies

Array = NDArray[np.float64]

NODES = 8
"""Speeds at which steady states are worked out for a sweep of more."""

NODES_UNDER_HEAT = 24
"""The same where heat bends or twists the blade at rest: speed then straightens it, within some of its lowest frequency."""

SLOWEST = 1e-3
"""rad/s: of the lowest node of steady states over Ω²."""

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
    omega = np.atleast_1d(real_numbers("speeds", speeds))
    if omega.ndim != 1 or not np.all(np.isfinite(omega) & (omega >= 0.0)):
        raise Refused("speeds", speeds, "zero or positive numbers of rad/s in one row")
    gyroscopic = checked("gyroscopic", gyroscopic, Flag())
    if isinstance(beams, RotatingBeam):
        return _sweep(beams, omega, count, motions, gyroscopic)
    if not isinstance(beams, (list, tuple)) or not beams:
        raise Refused("beams", beams, "a RotatingBeam or a list of one or more")
    for beam in beams:
        checked("beams", beam, Instance(RotatingBeam))
    return np.stack([_sweep(beam, omega, count, motions, gyroscopic) for beam in beams])


def _sweep(beam: RotatingBeam, speeds: Array, count: int, motions: tuple[str, ...] | None, gyroscopic: bool) -> Array:
    columns = beam.space.columns(motions)
    count = checked("count", count, Count(1, len(columns)))
    critical = beam.critical_speed
    frequencies = np.empty((len(speeds), count))
    below, beyond = np.flatnonzero(speeds < critical), np.flatnonzero(speeds >= critical)
    about_moving = beam.model == "blade" and beam.exact.nonlinear
    for diverged, group, nonlinear in ((False, below, about_moving), (True, beyond, False)):
        family = SteadyFamily.of(beam.exact, columns, speeds[group]) if nonlinear else LinearFamily.of(beam, columns)
        for start in range(0, len(group), STACK):
            picked = group[start : start + STACK]
            frequencies[picked] = _stack(*family.at(speeds[picked]), gyroscopic, diverged)[:, :count]
    return frequencies


@dataclass(frozen=True, slots=True, eq=False)
class LinearFamily:
    """K and G at any speed in coordinates in which M is the identity: K_e + Ω² K_Ω and Ω G₁."""

    elastic: Array
    spin: Array
    coupling: Array

    @classmethod
    def of(cls, beam: RotatingBeam, columns: NDArray[np.intp]) -> LinearFamily:
        """Of some coefficients of a beam, the others held at zero."""
        return cls(*mass_reduced(beam.matrices.restricted(columns)))

    def at(self, speeds: Array) -> tuple[Array, Array]:
        """(S, N, N) each."""
        omega = speeds[:, None, None]
        return self.elastic + omega**2 * self.spin, omega * self.coupling


@dataclass(frozen=True, slots=True, eq=False)
class SteadyFamily:
    """The same about the non-linear steady states, of which few are worked out: between them coefficients follow a polynomial.

    K itself must not: a polynomial of matrices mixes what is stiff at one speed into what is soft at another.
    """

    beam: ExactBeam
    columns: NDArray[np.intp]
    nodes: Array
    """Ω² (n,)."""
    coefficients: Array
    """(n, all), over Ω² where nothing moves the blade at rest."""
    heated: bool
    """Whether heat does."""

    @classmethod
    def of(cls, beam: ExactBeam, columns: NDArray[np.intp], speeds: Array) -> SteadyFamily:
        """For speeds (S,) in any order; where they are few each is worked out itself."""
        moving = np.maximum(speeds, SLOWEST) ** 2
        heated = beam.heat is not None
        count = NODES_UNDER_HEAT if heated else NODES
        nodes = np.unique(moving) if len(np.unique(moving)) <= count else _chebyshev(moving.min(), moving.max(), count)
        coefficients: list[Array] = []
        near: SteadyState | None = None
        for square in nodes.tolist():
            near = beam.at(float(np.sqrt(square)), near).steady
            assert near is not None
            coefficients.append(near.coefficients if heated else near.coefficients / square)
        return cls(beam, columns, nodes, np.array(coefficients), heated)

    def at(self, speeds: Array) -> tuple[Array, Array]:
        """(S, N, N) each."""
        states = between(self.nodes, speeds**2) @ self.coefficients
        if not self.heated:
            states = speeds[:, None] ** 2 * states
        stiffness, coupling = [], []
        for speed, state in zip(speeds.tolist(), states, strict=True):
            point = self.beam.at_stations.about(state, speed).restricted(self.columns)
            root = np.asarray(np.linalg.cholesky(point.mass), dtype=np.float64)
            stiffness.append(reduced(root, point.stiffness))
            coupling.append(reduced(root, point.gyroscopic))
        return np.array(stiffness), np.array(coupling)


def _chebyshev(low: float, high: float, count: int) -> Array:
    nodes = np.cos(np.pi * (np.arange(count)[::-1] + 0.5) / count)
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * nodes)


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
    if diverged:
        return diverged_frequencies(stiffness, gyroscopic)
    try:
        return stable_frequencies(stiffness, gyroscopic)
    except np.linalg.LinAlgError:  # a steady state may be unstable below the critical speed
        if len(stiffness) == 1:
            return diverged_frequencies(stiffness, gyroscopic)
        each = range(len(stiffness))
        return np.concatenate([_stack(stiffness[k : k + 1], gyroscopic[k : k + 1], coupled, diverged) for k in each])
