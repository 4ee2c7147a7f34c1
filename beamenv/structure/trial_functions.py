"""Galerkin's trial functions: polynomials over the whole span."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from beamenv.configuration.read_only import sealed
from beamenv.structure.span_space import SpanSpace, Table
from beamenv.structure.stations import Stations

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TrialSpace(SpanSpace):
    """(z/L)ᵏ times Legendre polynomials: the span of the thesis' monomials (Eq. 3.12), but well conditioned."""

    length: float
    terms: int
    rigid: bool
    warping: bool = False
    plane: bool = False
    clamp_reach: float = 1.0
    """m: distance from the clamp over which sections come to warp at will."""
    breaks: tuple[float, ...] = ()
    """m: where the blade's stiffness, or its rate of twist, jumps, and strains with it. Every field has a ramp and a parabola that
    begin there, every amplitude a ramp and a step, smooth within the clamp's reach."""

    held: ClassVar[float] = 1e-10

    @property
    def each(self) -> int:
        """Number of coefficients of each field."""
        return self.terms + 2 * len(self.breaks)

    @property
    def order(self) -> int:
        """As many stations as terms."""
        return self.terms

    @property
    def amplitude_terms(self) -> int:
        """The same as of each field."""
        return self.each

    def kind(self, field: str) -> int:
        """The power of z with which the functions leave the clamp."""
        return self.root_order(field)

    def count(self, kind: int) -> int:
        """The same of every kind."""
        return self.each

    def stations(self, breakpoints: Array, points: int, graded: bool = False) -> Stations:
        """As many on every piece, or ``graded``: the fewer the shorter it is."""
        return Stations.graded(breakpoints, points) if graded else Stations.between(breakpoints, points)

    def amplitude_table(self, z: Array) -> tuple[Array, Array]:
        """Polynomials, and at breaks ramps and steps that are smooth within the clamp's reach; less what decays within it from
        their value at the clamp.
        """
        smooth = clamped_table(z / self.length, self.terms, self.length, self.clamp_reach)
        if not self.breaks:
            return smooth
        apart = z[:, None] - np.array(self.breaks)
        near = 0.5 * np.exp(-np.abs(apart) / self.clamp_reach)
        held = 0.5 * np.exp(-(z[:, None] + np.array(self.breaks)) / self.clamp_reach)
        beyond = np.maximum(apart, 0.0) / self.length
        steps = np.where(apart > 0.0, 1.0 - near, near) - held, (near + held) / self.clamp_reach
        ramps = beyond, (beyond > 0.0) / self.length
        value, slope = (np.hstack(parts) for parts in zip(smooth, steps, ramps, strict=True))
        return value, slope

    def table(self, z: Array, kind: int) -> Table:
        """Values and first two derivatives (stations, each) of a field's functions, that leave the clamp with a power of z.

        With breaks they are orthonormal over the span.
        """
        if not self.breaks:
            return polynomial_table(z / self.length, kind, self.terms, self.length)
        value, first, second = (each @ orthonormal(self, kind) for each in self.broken_table(z, kind))
        return value, first, second

    def broken_table(self, z: Array, kind: int) -> Table:
        """Polynomials, then ramps and parabolas that begin at breaks: near the clamp or each other they are all but polynomials."""
        smooth = polynomial_table(z / self.length, kind, self.terms, self.length)
        beyond = np.maximum(z[:, None] - np.array(self.breaks), 0.0) / self.length
        there = (beyond > 0.0) / self.length
        ramps = beyond, there, np.zeros_like(there)
        parabolas = beyond**2, 2.0 * beyond * there, 2.0 * there**2
        value, first, second = (np.hstack(parts) for parts in zip(smooth, ramps, parabolas, strict=True))
        return value, first, second


@lru_cache
def orthonormal(space: TrialSpace, kind: int) -> Array:
    """R⁻¹ (each, each) of the QR factors of a field's functions with breaks, whose masses would else be singular to rounding."""
    rule = Stations.between(np.array([0.0, *space.breaks, space.length]), space.terms + 2)
    value = space.broken_table(rule.z, kind)[0]
    factor = np.linalg.qr(np.sqrt(rule.weight / space.length)[:, None] * value, mode="r")
    return sealed(np.asarray(solve_triangular(factor, np.eye(len(factor)))))


def polynomial_table(xi: Array, power: int, terms: int, length: float) -> tuple[Array, Array, Array]:
    """ξᵏ P_j(2ξ − 1) and its first two derivatives by z = ξL, each (stations, terms)."""
    value = legendre.legvander(2.0 * xi - 1.0, terms - 1)
    derivative = 2.0 * legendre_derivative(terms)
    first = value @ derivative
    second = first @ derivative
    x = xi[:, None]
    root, root_first, root_second = x**power, power * x ** (power - 1), power * (power - 1) * np.ones_like(x)
    return (
        root * value,
        (root_first * value + root * first) / length,
        (root_second * value + 2.0 * root_first * first + root * second) / length**2,
    )


def clamped_table(xi: Array, terms: int, length: float, reach: float) -> tuple[Array, Array]:
    """P_j(2ξ − 1) − P_j(−1) exp(−z/reach) and its first derivative by z = ξL, each (stations, terms).

    Zero at the clamp and polynomials beyond its reach (m), however slender the blade is.
    """
    value = legendre.legvander(2.0 * xi - 1.0, terms - 1)
    slope = value @ (2.0 * legendre_derivative(terms)) / length
    at_clamp = np.exp(-xi * length / reach)[:, None] * np.where(np.arange(terms) % 2, -1.0, 1.0)
    return value - at_clamp, slope + at_clamp / reach


@lru_cache
def legendre_derivative(terms: int) -> Array:
    """(terms, terms): column j has the Legendre coefficients of P_j'."""
    padded = np.zeros((terms, terms))
    derived = legendre.legder(np.eye(terms))
    padded[: len(derived)] = derived
    padded.setflags(write=False)
    return padded
