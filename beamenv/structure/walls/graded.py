"""Functionally graded walls: two isotropic materials whose shares change through the thickness by a power law."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Number, Range, Refused, configuration
from beamenv.structure.walls.depth_rules import DepthRule, power_rule
from beamenv.structure.walls.materials import Lamina
from beamenv.structure.walls.named import MATERIALS

Array = NDArray[np.float64]

SCHEMES = ("voigt", "mori-tanaka")

PURE = 1e6
"""Exponents from here on are infinite: the inner material alone; below its inverse they are zero: the outer one alone."""

Constituent = Annotated[str | Lamina, Choice(MATERIALS, Lamina)]


@dataclass(frozen=True, slots=True)
class Mixture:
    """Isotropic constants at places through a graded wall, (n,) each."""

    E: Array
    nu: Array
    density: Array
    alpha: Array | None

    @property
    def bulk(self) -> Array:
        """Pa."""
        return self.E / (3.0 * (1.0 - 2.0 * self.nu))

    @property
    def shear(self) -> Array:
        """Pa."""
        return self.E / (2.0 * (1.0 + self.nu))


@configuration("graded")
class FunctionallyGraded:
    """A material that changes from the ply's inner face to its outer one: at the share ξ of the thickness from the inner face,
    ξ to the power ``exponent`` of the volume is the outer material. Of a web and of an open wall the faces are as those of inlays.

    "voigt" mixes E, ν, density and expansion by volume (the rule of mixtures of Reddy and Chin, Journal of Thermal Stresses 21,
    1998). "mori-tanaka" takes the outer material for spheres in a matrix of the inner one: bulk and shear modulus by Mori and
    Tanaka, expansion by the bulk modulus (Hatta and Taya), density by volume (all in Vel and Batra, AIAA Journal 40, 2002).
    Both materials are isotropic, so the angle of a ply of it has no effect. A wall that is of one such material altogether is
    graded from its inner face to its outer one, whatever the number of its plies; a ply of it among others is graded by itself.
    Raises ``ValueError`` for a material that is not isotropic and for an exponent below 0.
    """

    inner: Constituent
    outer: Constituent
    """Names or laminae."""
    exponent: Annotated[float, Number(ge=0.0)]
    """0, or below 10⁻⁶: the outer material alone; 10⁶ or more: the inner one alone."""
    scheme: Annotated[str, Choice(SCHEMES)] = "voigt"
    covered: Annotated[tuple[float, float], Range(ge=0.0, le=1.0, falls=True)] = (0.0, 1.0)
    """Shares of the graded thickness at the ply's inner and outer face: what is left where an inlay takes the rest, and falling
    in a wall that is turned over."""

    def __post_init__(self) -> None:
        for name, material in zip(("inner", "outer"), self.constituents, strict=True):
            if not material.is_isotropic:
                raise Refused(name, getattr(self, name), "an isotropic material")
        if self.covered[0] == self.covered[1]:
            raise Refused("covered", self.covered, "two shares that differ")

    @property
    def constituents(self) -> tuple[Lamina, Lamina]:
        """Inner and outer material."""
        inner, outer = (MATERIALS[each] if isinstance(each, str) else each for each in (self.inner, self.outer))
        return inner, outer

    @property
    def uniform(self) -> Lamina | None:
        """The one material that it is made of, at exponents that leave the other out; None where it changes."""
        inner, outer = self.constituents
        if inner == outer or self.exponent >= PURE:
            return inner
        return outer if self.exponent <= 1.0 / PURE else None

    def at(self, temperature_K: float) -> FunctionallyGraded:
        """The material at a temperature, as of its constituents; itself where they have no curves."""
        inner, outer = (each.at(temperature_K) for each in self.constituents)
        if (inner, outer) == self.constituents:
            return self
        return replace(self, inner=inner, outer=outer)

    def scaled(self, modulus: float, mass: float) -> FunctionallyGraded:
        """With moduli and densities times ratios."""
        inner, outer = (each.scaled(modulus, mass) for each in self.constituents)
        return replace(self, inner=inner, outer=outer)

    def part(self, low: float, high: float) -> FunctionallyGraded:
        """What of it lies between two shares of the ply's thickness, graded as it is in the whole."""
        start, end = self.covered
        return replace(self, covered=(start + low * (end - start), start + high * (end - start)))

    @property
    def turned_over(self) -> FunctionallyGraded:
        """The same ply from its outer face to its inner."""
        start, end = self.covered
        return replace(self, covered=(end, start))

    def rule(self) -> DepthRule:
        """Places through the ply and their weights, which integrate polynomials of the depth times what is there to round-off."""
        return power_rule(self.exponent, *self.covered)

    def mixture(self, volume: Array) -> Mixture:
        """Constants where a share (n,) of the volume is the outer material."""
        return (_voigt if self.scheme == "voigt" else _mori_tanaka)(*self.constituents, volume)


@lru_cache(maxsize=64)
def mixture_through(material: FunctionallyGraded) -> tuple[DepthRule, Mixture]:
    """A graded ply's places through its thickness and what it is there."""
    rule = material.rule()
    return rule, material.mixture(rule.volume)


@lru_cache(maxsize=64)
def laminae_through(material: FunctionallyGraded) -> tuple[Lamina, ...]:
    """What a wall's law asks for at each place; isotropic as its constituents are, and not checked again."""
    _, mixture = mixture_through(material)
    alphas = np.full_like(mixture.E, np.nan) if mixture.alpha is None else mixture.alpha
    columns = (mixture.E, mixture.nu, mixture.shear, mixture.density, alphas)
    return tuple(_lamina(*row) for row in np.stack(columns, axis=1).tolist())


def _lamina(E: float, nu: float, G: float, density: float, alpha: float) -> Lamina:
    made: Lamina = object.__new__(Lamina)
    known = None if np.isnan(alpha) else alpha
    values = {"E1": E, "E2": E, "G12": G, "G13": G, "G23": G, "nu12": nu, "density": density, "alpha1": known, "alpha2": known}
    for name, value in (*values.items(), ("curves", ())):
        object.__setattr__(made, name, value)
    return made


def _expansions(inner: Lamina, outer: Lamina) -> tuple[float, float] | None:
    if inner.alpha1 is None or outer.alpha1 is None:
        return None
    return inner.alpha1, outer.alpha1


def _voigt(inner: Lamina, outer: Lamina, volume: Array) -> Mixture:
    def mixed(first: float, last: float) -> Array:
        return first + (last - first) * volume

    expansions = _expansions(inner, outer)
    alpha = None if expansions is None else mixed(*expansions)
    return Mixture(mixed(inner.E1, outer.E1), mixed(inner.nu12, outer.nu12), mixed(inner.density, outer.density), alpha)


def _mori_tanaka(inner: Lamina, outer: Lamina, volume: Array) -> Mixture:
    (Km, Gm), (Kc, Gc) = ((each.E1 / (3.0 * (1.0 - 2.0 * each.nu12)), each.G12) for each in (inner, outer))
    of_shear = Gm * (9.0 * Km + 8.0 * Gm) / (6.0 * (Km + 2.0 * Gm))
    by_bulk = volume / (1.0 + (1.0 - volume) * (Kc - Km) / (Km + 4.0 / 3.0 * Gm))
    K = Km + (Kc - Km) * by_bulk
    G = Gm + (Gc - Gm) * volume / (1.0 + (1.0 - volume) * (Gc - Gm) / (Gm + of_shear))
    density = inner.density + (outer.density - inner.density) * volume
    expansions = _expansions(inner, outer)
    # (1/K − 1/Km) / (1/Kc − 1/Km), which is by_bulk Kc/K, also where both bulk moduli are alike
    alpha = None if expansions is None else expansions[0] + (expansions[1] - expansions[0]) * by_bulk * Kc / K
    return Mixture(9.0 * K * G / (3.0 * K + G), (3.0 * K - 2.0 * G) / (2.0 * (3.0 * K + G)), density, alpha)
