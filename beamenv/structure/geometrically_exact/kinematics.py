"""A beam's reference line and sections in space: strains, and how they change to first and second order.

At span z the section stands at r = (R₀ + z) ẑ + u and is turned by C = R C₀, C₀ being the turn by presetting and pretwist and
R = exp(ĉ). Its strains, in its own axes, are

    (γx, γy, ε) = Cᵀ r′ − ẑ,        κ = C₀ᵀ axial(Rᵀ R′),

and an increment δu, ϑ (a spin: C becomes exp(ϑ̂) C) changes them by

    Cᵀ (δu′ + r′ × ϑ),        Cᵀ ϑ′

(Simo and Vu-Quoc, Computer Methods in Applied Mechanics and Engineering 58, 1986). Quadratic forms here are of increments
[δu, ϑ, δu′, ϑ′], 12 numbers, at each of S stations.

A fibre's extension, Green's, has a quadratic part, ½ [(γx − κ₃ y)² + (γy + κ₃ x)² + (ε + κ₁ y − κ₂ x)²]: on it the spanwise stress
works as well. Tension then stiffens the twist (the trapeze effect), the transverse shear, and a little the stretch itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed
from beamenv.structure.geometrically_exact.rotations import curvature, hat, rotation

Array = NDArray[np.float64]

INCREMENT = 12
MOVE, SPIN, MOVE_SLOPE, SPIN_SLOPE = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12)

ALONG = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, eq=False)
class Placement(Sealed):
    """Where the reference line and the sections are at S stations."""

    displacement: Array
    """u (S, 3), m."""
    slope: Array
    """r′ = ẑ + u′ (S, 3)."""
    turn: Array
    """R (S, 3, 3): from the unloaded blade."""
    frame: Array
    """C (S, 3, 3): the section's axes."""
    strain: Array
    """(S, 6): γx, γy, ε, κ in the section's axes."""

    @classmethod
    def of(cls, state: Array, frame: Array) -> Placement:
        """From [u, c, u′, c′] (S, 12) and the unloaded blade's frames C₀ (S, 3, 3)."""
        turn, slope = rotation(state[:, SPIN]), ALONG + state[:, MOVE_SLOPE]
        turned = turn @ frame
        stretched = (turned.swapaxes(-1, -2) @ slope[..., None])[..., 0] - ALONG
        curved = (frame.swapaxes(-1, -2) @ curvature(state[:, SPIN], state[:, SPIN_SLOPE])[..., None])[..., 0]
        return cls(state[:, MOVE], slope, turn, turned, np.concatenate([stretched, curved], axis=-1))

    @property
    def strain_rows(self) -> Array:
        """(S, 6, 12): change of the strains per increment."""
        rows = np.zeros((len(self.frame), 6, INCREMENT))
        own = self.frame.swapaxes(-1, -2)
        rows[:, :3, SPIN], rows[:, :3, MOVE_SLOPE], rows[:, 3:, SPIN_SLOPE] = own @ hat(self.slope), own, own
        return rows

    def geometric(self, resultants: Array) -> Array:
        """(S, 12, 12): resultants (S, 6), in the section's axes, times the strains' second change."""
        force, moment = ((self.frame @ part[..., None])[..., 0] for part in (resultants[:, :3], resultants[:, 3:]))
        form = np.zeros((len(force), INCREMENT, INCREMENT))
        across = self.slope[:, :, None] * force[:, None, :]
        form[:, SPIN, SPIN] = (
            0.5 * (across + across.swapaxes(-1, -2)) - np.eye(3) * np.trace(across, axis1=-2, axis2=-1)[:, None, None]
        )
        form[:, SPIN, MOVE_SLOPE], form[:, MOVE_SLOPE, SPIN] = hat(force), hat(force).swapaxes(-1, -2)
        half = 0.5 * hat(moment)
        form[:, SPIN, SPIN_SLOPE], form[:, SPIN_SLOPE, SPIN] = half, half.swapaxes(-1, -2)
        return form


@dataclass(frozen=True, slots=True, eq=False)
class FibreExtension:
    """The quadratic part of the fibres' extension: squares (S, 6), to which the moments ∫σ_zz (1, x, y, x², xy, y²) dA are
    conjugate with a factor ½, and their slopes (S, 6, 6) per strain.
    """

    squares: Array
    slopes: Array

    @classmethod
    def of(cls, strain: Array) -> FibreExtension:
        """At strains (S, 6)."""
        slopes = np.einsum("fij,sj->sfi", CURVATURES, strain)
        return cls(0.5 * np.einsum("sfi,si->sf", slopes, strain), slopes)

    def beyond(self, free: Array) -> FibreExtension:
        """The same beside strains (S, 6) that make no stress: their squares make none either."""
        return FibreExtension(self.squares - FibreExtension.of(free).squares, self.slopes)

    def resultants(self, moments: Array, per_strain: Array) -> Array:
        """(S, 6) of the energy ½ moments · squares, with moments (S, 6) = per_strain (S, 6, 6) strain."""
        return 0.5 * (np.einsum("sfi,sf->si", per_strain, self.squares) + np.einsum("sfi,sf->si", self.slopes, moments))

    def stiffness(self, moments: Array, per_strain: Array) -> Array:
        """(S, 6, 6): its second change per strain."""
        mixed = 0.5 * per_strain.swapaxes(-1, -2) @ self.slopes
        return np.asarray(mixed + mixed.swapaxes(-1, -2) + under_stress(moments))


CURVATURES = np.zeros((6, 6, 6))
"""Second derivatives of the squares by the strains."""
CURVATURES[0, [0, 1, 2], [0, 1, 2]] = 2.0
CURVATURES[1, [1, 5, 2, 4], [5, 1, 4, 2]] = 2.0, 2.0, -2.0, -2.0
CURVATURES[2, [0, 5, 2, 3], [5, 0, 3, 2]] = -2.0, -2.0, 2.0, 2.0
CURVATURES[3, [5, 4], [5, 4]] = 2.0
CURVATURES[4, [3, 4], [4, 3]] = -2.0
CURVATURES[5, [5, 3], [5, 3]] = 2.0
CURVATURES.setflags(write=False)


def under_stress(moments: Array) -> Array:
    """(S, 6, 6): stiffness that moments (S, 6) of the spanwise stress give by the fibres' quadratic extension alone."""
    return 0.5 * np.einsum("sf,fij->sij", moments, CURVATURES)
