"""Extended Galerkin assembly: the speed-independent matrices of a rotating blade, from its energies.

    M q̈ + (Ω G₁) q̇ + (K_e + Ω² K_Ω) q = f

with M, K_e, K_Ω symmetric and G₁ skew (thesis §2.2 and §3.2 in quadratic form, misprints corrected).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import ReadOnly
from beamenv.structure.section.inertia import SectionInertia
from beamenv.structure.span_space import SpanSpace
from beamenv.structure.stations import Stations

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class BeamMatrices(ReadOnly):
    """M, K_e, K_Ω and G₁, each (N, N), with K = K_e + Ω² K_Ω and G = Ω G₁."""

    mass: Array
    elastic_stiffness: Array
    spin_stiffness: Array
    """Centrifugal stiffening less spin softening, per (rad/s)²."""
    gyroscopic: Array
    """Per rad/s."""

    @property
    def regular(self) -> bool:
        """Whether every number is finite, and mass and stiffness are positive definite by more than rounding."""
        if not all(np.isfinite(each).all() for each in (self.mass, self.elastic_stiffness, self.spin_stiffness, self.gyroscopic)):
            return False
        return definite(self.mass) and definite(self.elastic_stiffness)

    def stiffness(self, speed: float) -> Array:
        """K (N, N) at a speed in rad/s."""
        return self.elastic_stiffness + speed**2 * self.spin_stiffness

    def restricted(self, columns: NDArray[np.intp]) -> BeamMatrices:
        """The matrices of some coefficients alone, the others held at zero."""
        pick = np.ix_(columns, columns)
        return BeamMatrices(self.mass[pick], self.elastic_stiffness[pick], self.spin_stiffness[pick], self.gyroscopic[pick])


def definite(matrix: Array) -> bool:
    """Whether a symmetric matrix is positive definite by more than rounding, n ε of its diagonal, may make or take."""
    diagonal = np.diagonal(matrix)
    if not np.all(diagonal > 0.0):
        return False
    unit = 1.0 / np.sqrt(diagonal)
    rounding = len(matrix) * np.finfo(np.float64).eps
    try:
        np.linalg.cholesky(unit[:, None] * matrix * unit - rounding * np.eye(len(matrix)))
    except np.linalg.LinAlgError:
        return False
    return True


def generalised_strains(rows: dict[tuple[str, int], Array]) -> Array:
    """(S, 9, N): the generalised strains of the trial functions, in the order of ``wall_kinematics.STRAINS``."""
    return np.stack(
        [
            rows["s", 1],
            rows["theta_x", 1],
            rows["theta_y", 1],
            rows["u", 1] - rows["theta_y", 0],
            rows["v", 1] + rows["theta_x", 0],
            rows["u", 2],
            rows["v", 2],
            rows["phi", 1],
            rows["phi", 2],
        ],
        axis=1,
    )


def generalised_displacements(rows: dict[tuple[str, int], Array]) -> Array:
    """(S, 9, N): in the order of ``wall_kinematics.DISPLACEMENTS``."""
    order = [("u", 0), ("v", 0), ("s", 0), ("theta_x", 0), ("theta_y", 0), ("phi", 0), ("phi", 1), ("u", 1), ("v", 1)]
    return np.stack([rows[key] for key in order], axis=1)


def integrate(weight: Array, left: Array, section: Array, right: Array) -> Array:
    """∫ leftᵀ section right dz (N, N) from stations (S,), (S, 9, N), (S, 9, 9), (S, 9, N)."""
    weighted = (weight[:, None, None] * section) @ right
    return left.reshape(-1, left.shape[-1]).T @ weighted.reshape(-1, right.shape[-1])


def assemble(
    space: SpanSpace, stations: Stations, section_stiffness: Array, inertia: SectionInertia, hub_radius: float
) -> BeamMatrices:
    """Integrate section matrices (S, 9, 9) over the span."""
    rows = space.evaluate(stations.z)
    strain, motion = generalised_strains(rows), generalised_displacements(rows)
    spin = integrate(stations.weight, motion, inertia.spin_stiffness, motion)
    spin += centrifugal_stiffening(rows, stations, inertia, hub_radius)
    half = integrate(stations.weight, motion, 2.0 * inertia.lag_span, motion)
    return BeamMatrices(
        mass=symmetric(integrate(stations.weight, motion, inertia.mass, motion)),
        elastic_stiffness=symmetric(integrate(stations.weight, strain, section_stiffness, strain)),
        spin_stiffness=symmetric(spin),
        gyroscopic=half - half.T,
    )


def centrifugal_stiffening(
    rows: dict[tuple[str, int], Array], stations: Stations, inertia: SectionInertia, hub_radius: float
) -> Array:
    """∫ T(z) (u'u' + v'v' + (I_p/m) φ'φ') dz per Ω² (N, N), with T(z) = ∫_z^L m (R₀ + σ) dσ."""
    mass = inertia.mass_per_length
    tension = stations.integral_to_tip(mass * (hub_radius + stations.z))
    total = np.zeros((rows["u", 1].shape[1],) * 2)
    for key, factor in ((("u", 1), 1.0), (("v", 1), 1.0), (("phi", 1), inertia.polar / mass)):
        slope = rows[key]
        total += slope.T @ ((stations.weight * tension * factor)[:, None] * slope)
    return total


def symmetric(matrix: Array) -> Array:
    """The symmetric part: round-off removed."""
    return 0.5 * (matrix + matrix.T)
