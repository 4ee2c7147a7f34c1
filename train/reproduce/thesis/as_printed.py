"""The thesis' blade by equations that it prints and that do not hold: its tension under taper and its Q̄ (Eq. 4.5)."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BeamConfig
from beamenv.patches import PatchLayout
from beamenv.structure import RotatingBeam
from beamenv.structure.assembly import BeamMatrices
from beamenv.structure.walls.materials import Lamina

Array = NDArray[np.float64]


def uniform_tension(mass: Array, hub_radius: float, length: float, z: Array) -> Array:
    """b₁(z) R(z) per Ω² (S,), N/(rad/s)²: R = R₀(L − z) + ½(L² − z²) of a uniform beam, times the mass per length (S,) at z."""
    return mass * (hub_radius * (length - z) + 0.5 * (length**2 - z**2))


class UniformTensionBeam(RotatingBeam):
    """A blade under the tension that the thesis takes (b₁ R_z in Eqs. 2.23 to 2.51, R below Eq. 2.60), tapered or not."""

    def _wall_matrices(self) -> BeamMatrices:
        true = super()._wall_matrices()
        stations = self.space.stations(self.breakpoints(self._edges), self.stations_per_span)
        inertia, rows = self.walls_at(stations.z).inertia(), self.space.evaluate(stations.z)
        mass = inertia.mass_per_length
        excess = uniform_tension(mass, self.hub_radius, self.length, stations.z)
        excess = excess - stations.integral_to_tip(mass * (self.hub_radius + stations.z))
        spin = true.spin_stiffness.copy()
        for field, factor in (("u", 1.0), ("v", 1.0), ("phi", inertia.polar / mass)):
            slope = rows[field, 1]
            spin += slope.T @ ((stations.weight * excess * factor)[:, None] * slope)
        return replace(true, spin_stiffness=spin)


class UniformTensionBlade(BeamConfig):
    """The configuration of such a blade."""

    def build(self, layout: PatchLayout | None = None, model: str = "thesis") -> RotatingBeam:
        """The blade, with the inlays of passive patches when a layout is given."""
        beam = super().build(layout, model)
        return UniformTensionBeam(**{each.name: getattr(beam, each.name) for each in fields(RotatingBeam)})


class PrintedQ12(Lamina):
    """A ply whose Q̄12 is that of Eq. 4.5, with Q22 where Q12 belongs."""

    def transformed_stiffness(self, angle: float) -> Array:
        """Q̄ (3, 3), Pa, for (ε_ss, ε_zz, γ_sz), the fibres ``angle`` (rad) from s towards z."""
        turned = super().transformed_stiffness(angle)
        turned[[0, 1], [1, 0]] = printed_stiffness(self, angle)[0, 1]
        return turned


class PrintedQ(Lamina):
    """A ply with all of Eq. 4.5 as printed."""

    def transformed_stiffness(self, angle: float) -> Array:
        """Q̄ (3, 3), Pa: not positive definite but at 0°."""
        return printed_stiffness(self, angle)


def printed_stiffness(ply: Lamina, angle: float) -> Array:
    """Q̄ (3, 3), Pa, by Eq. 4.5 as printed: its Q̄12, Q̄16, Q̄26 and Q̄66 are not those of Jones (Eq. 2.84)."""
    straight = Lamina.reduced_stiffness(ply)
    q11, q12, q22, q66 = straight[0, 0], straight[0, 1], straight[1, 1], straight[2, 2]
    c, s = np.cos(angle), np.sin(angle)
    mixed = (2.0 * q12 + 4.0 * q66) * s**2 * c**2
    one, other = q11 - q12 - 2.0 * q66, q12 - q22 + 2.0 * q66
    q12_bar = (q11 + q22 - 4.0 * q66) * s**2 * c**2 + q22 * (s**4 + c**4)
    q16_bar, q26_bar = s * c * (one * s**2 + other * c**2), s * c * (one * c**2 + other * s**2)
    q66_bar = s**2 * c**4 * (q11 - 2.0 * q12 + q22) + (c**4 - s**4) * q66
    return np.array(
        [
            [q11 * c**4 + mixed + q22 * s**4, q12_bar, q16_bar],
            [q12_bar, q11 * s**4 + mixed + q22 * c**4, q26_bar],
            [q16_bar, q26_bar, q66_bar],
        ]
    )
