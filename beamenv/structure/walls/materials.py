"""Orthotropic laminae, and what temperature makes of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Real, Refused, checked, configuration
from beamenv.structure.walls.curves import DATA_KELVIN, Curve, Curves, range_of, share

Modulus = Annotated[float, Number(gt=0.0, unit="Pa")]
Density = Annotated[float, Number(gt=0.0, unit="kg/m³")]
EXPANSION = Number(ge=-1e-2, le=1e-2, unit="1/K")
Expansion = Annotated[float | None, EXPANSION]

MODULI = ("E1", "E2", "G12", "G13", "G23")

FOLLOWED = ("E1", "nu12", "alpha1")
"""In an isotropic material: what all else follows from."""


@configuration("lamina")
class Lamina:
    """A unidirectional ply in its material axes: 1 along the fibres, 2 across them in the plane, 3 through the thickness.

    Raises ``ValueError`` for a modulus or density that is not positive, for |ν12| ≥ √(E1/E2), where the ply would store negative
    energy, and for curves of what is unknown or, in an isotropic material, of what follows from others.
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
    alpha1: Expansion = None
    alpha2: Expansion = None
    """1/K, along the fibres and across them, from the temperature at which nothing is strained to the one at hand: the mean between
    the two. None: unknown, and refused where heat strains the blade."""
    curves: Annotated[tuple[tuple[str, Curve], ...], Curves()] = ()
    """Shares of the constants over temperature, for any of E1, E2, G12, G13, G23, nu12, alpha1, alpha2; a mapping will do. A
    property without a curve keeps its constant. In an isotropic material those of E1, nu12 and alpha1 are of all directions."""

    def __post_init__(self) -> None:
        if not abs(self.nu12) < np.sqrt(self.E1 / self.E2):
            raise Refused("nu12", self.nu12, f"smaller in magnitude than sqrt(E1/E2) = {np.sqrt(self.E1 / self.E2):.4g}")
        for name, _ in self.curves:
            if getattr(self, name) is None:
                raise Refused(name, None, "a number (1/K) where it has a curve over temperature")
            if self.is_isotropic and name not in FOLLOWED:
                raise Refused("curves", [name], f"of {', '.join(FOLLOWED)} alone in an isotropic material")
        if self.range_K is not None and self.range_K[0] > self.range_K[1]:
            raise Refused("curves", [name for name, _ in self.curves], "curves that all hold at some temperature (K)")

    @classmethod
    def isotropic(
        cls, E: float, nu: float, density: float, alpha: float | None = None, curves: Mapping[str, Curve] = MappingProxyType({})
    ) -> Lamina:
        """An isotropic sheet with Young's modulus E (Pa), Poisson's ratio nu, density (kg/m³), expansion alpha (1/K), if known, and
        curves over temperature of E1, nu12 and alpha1.
        """
        E = checked("E", E, Number(gt=0.0, unit="Pa"))
        nu = checked("nu", nu, Number(gt=-1.0, lt=0.5))
        shear_modulus = E / (2.0 * (1.0 + nu))
        moduli = {"E1": E, "E2": E, "G12": shear_modulus, "G13": shear_modulus, "G23": shear_modulus}
        return cls(**moduli, nu12=nu, density=density, alpha1=alpha, alpha2=alpha, curves=curves)  # type: ignore[arg-type]

    @property
    def is_isotropic(self) -> bool:
        """Whether all directions are alike, to nine digits."""
        shear_modulus = self.E1 / (2.0 * (1.0 + self.nu12)) if self.nu12 > -1.0 else np.inf
        alike = np.allclose([self.E2, self.G12, self.G13, self.G23], [self.E1, *[shear_modulus] * 3], rtol=1e-9, atol=0.0)
        return bool(alike) and self.nu12 < 0.5 and self.alpha1 == self.alpha2

    @property
    def range_K(self) -> tuple[float, float] | None:
        """Lowest and highest temperature at which all curves hold; None without curves."""
        ranges = [range_of(curve) for _, curve in self.curves]
        return (max(low for low, _ in ranges), min(high for _, high in ranges)) if ranges else None

    def at(self, temperature_K: float) -> Lamina:
        """The material at a temperature: constants alone. Without curves it is this very object, whose constants hold at any.

        Raises ``ValueError`` beyond the range of the curves.
        """
        temperature_K = checked("temperature", temperature_K, DATA_KELVIN)
        if self.range_K is None:
            return self
        low, high = self.range_K
        if not low <= temperature_K <= high:
            raise Refused("temperature", temperature_K, f"a number from {low:g} to {high:g} (K), where data of the material hold")
        values = {name: getattr(self, name) * share(curve, temperature_K) for name, curve in self.curves}
        if not self.is_isotropic:
            return replace(self, curves=(), **values)
        E, nu, alpha = (values.get(name, getattr(self, name)) for name in FOLLOWED)
        return Lamina.isotropic(E, nu, self.density, alpha)

    def scaled(self, modulus: float, mass: float) -> Lamina:
        """With moduli and density times ratios."""
        stiffer = {name: modulus * getattr(self, name) for name in MODULI}
        return replace(self, density=mass * self.density, **stiffer)

    @property
    def expansion(self) -> tuple[float, float]:
        """alpha1, alpha2 (1/K); ``ValueError`` where one is unknown."""
        for name in ("alpha1", "alpha2"):
            if getattr(self, name) is None:
                raise Refused(f"material.{name}", None, "a number (1/K) where temperature strains the blade")
        return self.alpha1, self.alpha2  # type: ignore[return-value]

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
