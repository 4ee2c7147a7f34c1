"""Orthotropic laminae."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Real, Refused, checked, configuration

Modulus = Annotated[float, Number(gt=0.0, unit="Pa")]
Density = Annotated[float, Number(gt=0.0, unit="kg/m³")]


@configuration("lamina")
class Lamina:
    """A unidirectional ply in its material axes: 1 along the fibres, 2 across them in the plane, 3 through the thickness.

    Raises ``ValueError`` for a modulus or density that is not positive and for |ν12| ≥ √(E1/E2), where the ply would
    store negative energy.
    """

    E1: Modulus
    """Pa."""
    E2: Modulus
    """Pa."""
    G12: Modulus
    """Pa."""
    G13: Modulus
    """Pa."""
    G23: Modulus
    """Pa."""
    nu12: Real
    """Contraction along 2 per extension along 1."""
    density: Density
    """kg/m³."""

    def __post_init__(self) -> None:
        if not abs(self.nu12) < np.sqrt(self.E1 / self.E2):
            raise Refused("nu12", self.nu12, f"smaller in magnitude than sqrt(E1/E2) = {np.sqrt(self.E1 / self.E2):.4g}")

    @classmethod
    def isotropic(cls, E: float, nu: float, density: float) -> Lamina:
        """An isotropic sheet with Young's modulus E (Pa), Poisson's ratio nu and density (kg/m³)."""
        E = checked("E", E, Number(gt=0.0, unit="Pa"))
        nu = checked("nu", nu, Number(gt=-1.0, lt=0.5))
        shear_modulus = E / (2.0 * (1.0 + nu))
        return cls(E1=E, E2=E, G12=shear_modulus, G13=shear_modulus, G23=shear_modulus, nu12=nu, density=density)

    def reduced_stiffness(self) -> NDArray[np.float64]:
        """Plane-stress stiffness Q (3, 3) in Pa for (ε1, ε2, γ12); Jones, Mechanics of Composite Materials, Eq. 2.70."""
        determinant = 1.0 - self.nu12**2 * self.E2 / self.E1
        q12 = self.nu12 * self.E2 / determinant
        return np.array([[self.E1 / determinant, q12, 0.0], [q12, self.E2 / determinant, 0.0], [0.0, 0.0, self.G12]])

    def transformed_stiffness(self, angle: float) -> NDArray[np.float64]:
        """Q̄ (3, 3) in Pa for (ε_ss, ε_zz, γ_sz) with the fibres ``angle`` (rad) from s towards z; Jones, Eq. 2.84."""
        to_material = strain_rotation(angle)
        return to_material.T @ self.reduced_stiffness() @ to_material

    def transverse_shear_stiffness(self, angle: float) -> float:
        """Q̄44 in Pa for γ_nz: G23 cos² + G13 sin²."""
        return float(self.G23 * np.cos(angle) ** 2 + self.G13 * np.sin(angle) ** 2)

    @property
    def nu23(self) -> float:
        """Contraction through the thickness per extension across the fibres: that of a ply isotropic in the plane 2, 3,
        E2/2G23 − 1, or as near to it as leaves its energy positive.
        """
        most = 1.0 - 2.0 * self.nu12**2 * self.E2 / self.E1
        return float(np.clip(0.5 * self.E2 / self.G23 - 1.0, -0.95, most - 1e-3 * (1.0 + most)))

    def solid_stiffness(self) -> NDArray[np.float64]:
        """(6, 6) in Pa for (ε1, ε2, ε3, γ12, γ13, γ23), with E3 = E2 and ν13 = ν12."""
        compliance = np.zeros((6, 6))
        along, across = -self.nu12 / self.E1, -self.nu23 / self.E2
        compliance[:3, :3] = [[1.0 / self.E1, along, along], [along, 1.0 / self.E2, across], [along, across, 1.0 / self.E2]]
        compliance[[3, 4, 5], [3, 4, 5]] = 1.0 / self.G12, 1.0 / self.G13, 1.0 / self.G23
        return np.asarray(np.linalg.inv(compliance), dtype=np.float64)


def wall_stiffness(material: Lamina, angle: float) -> NDArray[np.float64]:
    """(6, 6) in Pa for (ε_ss, ε_nn, γ_sn, γ_sz, γ_nz, ε_zz) of a wall, with the fibres ``angle`` (rad) from s towards z."""
    c, s = np.cos(angle), np.sin(angle)
    to_material = np.zeros((6, 6))  # 1 = c s + s z, 2 = −s s + c z, 3 = n
    to_material[0, [0, 3, 5]] = c * c, c * s, s * s
    to_material[1, [0, 3, 5]] = s * s, -c * s, c * c
    to_material[2, 1] = 1.0
    to_material[3, [0, 3, 5]] = -2.0 * c * s, c * c - s * s, 2.0 * c * s
    to_material[4, [2, 4]] = c, s
    to_material[5, [2, 4]] = -s, c
    return np.asarray(to_material.T @ material.solid_stiffness() @ to_material)


def strain_rotation(angle: float) -> NDArray[np.float64]:
    """(3, 3): engineering strains (ε_ss, ε_zz, γ_sz) of the wall to (ε1, ε2, γ12) of a ply turned by ``angle`` (rad)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])


GRAPHITE_EPOXY = Lamina(E1=206.8e9, E2=5.17e9, G12=3.1e9, G13=3.1e9, G23=2.5511e9, nu12=0.25, density=1528.15)
"""The thesis' blade (Table 5.1)."""

AS4_3501_6 = Lamina(E1=141.93e9, E2=9.788e9, G12=6.135e9, G13=6.135e9, G23=4.8e9, nu12=0.42, density=1444.8)
"""The graphite-epoxy of Chandra and Chopra's box beams (Journal of Aircraft 29, 1992)."""

ALUMINIUM = Lamina.isotropic(E=68.9e9, nu=0.33, density=2700.0)
"""6061-T6 (ASM Aerospace Specification Metals)."""
