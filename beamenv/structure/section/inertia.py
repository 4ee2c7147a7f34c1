"""Section inertia: mass, rotary inertia, spin softening and gyroscopic coupling per metre of span."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.walls.wall_kinematics import DPHI, PointMotion

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class SectionInertia:
    """∮∫ρ XᵀY dn ds (S, 9, 9) for the generalised displacements, X and Y being U (lag), V (flap) and W (span)."""

    lag_lag: Array
    flap_flap: Array
    span_span: Array
    lag_span: Array

    @classmethod
    def integrate(cls, motion: PointMotion, density: Array, ds: Array) -> SectionInertia:
        """Integrate over the walls, from the density moments (S, P, 7)."""
        powers = np.add.outer(motion.powers, motion.powers)
        weight = ds[..., None, None] * density[..., powers]

        def product(left: Array, right: Array) -> Array:
            stations = len(left)
            return left.reshape(stations, -1, 9).transpose(0, 2, 1) @ (weight @ right).reshape(stations, -1, 9)

        return cls(
            lag_lag=product(motion.lag, motion.lag),
            flap_flap=product(motion.flap, motion.flap),
            span_span=product(motion.span, motion.span),
            lag_span=product(motion.lag, motion.span),
        )

    @property
    def mass(self) -> Array:
        """(S, 9, 9)."""
        return self.lag_lag + self.flap_flap + self.span_span

    @property
    def mass_per_length(self) -> Array:
        """(S,), kg/m."""
        return self.lag_lag[:, 0, 0]

    @property
    def polar(self) -> Array:
        """I_p (S,), kg m."""
        return self.lag_lag[:, DPHI, DPHI] + self.flap_flap[:, DPHI, DPHI]

    @property
    def spin_stiffness(self) -> Array:
        """(S, 9, 9), kg/m etc., to be multiplied by Ω²: spin softening with the tennis-racket term."""
        softening = -(self.lag_lag + self.span_span)
        softening[:, DPHI, DPHI] += self.flap_flap[:, DPHI, DPHI]
        return softening
