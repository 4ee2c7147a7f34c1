"""Trial functions along the span and Gauss stations to integrate them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from beamenv.configuration import Refused, Texts, checked
from beamenv.configuration.read_only import Sealed, sealed

Array = NDArray[np.float64]

FIELDS = ("u", "v", "s", "theta_x", "theta_y", "phi")
"""Lag, flap, arc-length stretch, section rotations about x and y, twist."""

MOTIONS = {"lag": ("u", "theta_y"), "flap": ("v", "theta_x"), "extension": ("s",), "twist": ("phi",)}
"""The fields of each family of motion: a bending displacement with its section rotation."""

ROOT_ORDER = {"u": 2, "v": 2, "phi": 2, "s": 1, "theta_x": 1, "theta_y": 1}
"""The power of z with which a field leaves the clamp: 2 where its slope vanishes there too."""


@dataclass(frozen=True, slots=True)
class TrialSpace:
    """(z/L)ᵏ times Legendre polynomials: the span of the thesis' monomials (Eq. 3.12), but well conditioned.

    In rigid theory the section rotations are no fields of their own: θy = u', θx = −v'.
    """

    length: float
    terms: int
    rigid: bool
    warping: bool = False
    """Whether sections warp at will and shear, so that no slope need vanish at the clamp."""
    plane: bool = False
    """Whether sections stay plane in torsion, so that the clamp holds no warping back."""
    clamp_reach: float = 1.0
    """m: distance from the clamp over which sections come to warp at will."""
    breaks: tuple[float, ...] = ()
    """m: where the blade's stiffness jumps, and strains with it. Every field has a ramp and a parabola that begin there."""

    def root_order(self, field: str) -> int:
        """The power of z with which a field leaves the clamp."""
        bends = field in ("u", "v") and self.rigid
        free = self.warping or (field == "phi" and self.plane)
        return ROOT_ORDER[field] if bends or not free else 1

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields that have coefficients of their own, in the order of the coefficient vector."""
        return tuple(name for name in FIELDS if not (self.rigid and name.startswith("theta")))

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return self.each * len(self.fields)

    @property
    def each(self) -> int:
        """Number of coefficients of each field."""
        return self.terms + 2 * len(self.breaks)

    def columns(self, motions: tuple[str, ...] | None) -> NDArray[np.intp]:
        """Indices of the coefficients that belong to ``motions`` (None: all)."""
        if motions is not None and not set(checked("motions", motions, Texts()) or ("none",)) <= set(MOTIONS):
            raise Refused("motions", motions, f"a list of one or more of {', '.join(MOTIONS)}")
        wanted = FIELDS if motions is None else [name for motion in motions for name in MOTIONS[motion]]
        blocks = [np.arange(self.each) + self.each * k for k, name in enumerate(self.fields) if name in wanted]
        return np.concatenate(blocks)

    def evaluate(self, z: Array) -> dict[tuple[str, int], Array]:
        """Rows (stations, size) that give each field's derivative: keys (field, order), orders 0, 1, 2."""
        tables = {power: self.table(z, power) for power in (1, 2)}
        rows: dict[tuple[str, int], Array] = {}
        for index, name in enumerate(self.fields):
            block = slice(index * self.each, (index + 1) * self.each)
            for order in range(3):
                row = np.zeros((len(z), self.size))
                row[:, block] = tables[self.root_order(name)][order]
                rows[name, order] = row
        if self.rigid:
            for order in range(2):
                rows["theta_y", order] = rows["u", order + 1]
                rows["theta_x", order] = -rows["v", order + 1]
        return rows

    def table(self, z: Array, power: int) -> tuple[Array, Array, Array]:
        """Values and first two derivatives (stations, each) of a field's functions, that leave the clamp with a power of z."""
        smooth = polynomial_table(z / self.length, power, self.terms, self.length)
        if not self.breaks:
            return smooth
        beyond = np.maximum(z[:, None] - np.array(self.breaks), 0.0) / self.length
        there = (beyond > 0.0) / self.length
        ramps = beyond, there, np.zeros_like(there)
        parabolas = beyond**2, 2.0 * beyond * there, 2.0 * there**2
        value, first, second = (np.hstack(parts) for parts in zip(smooth, ramps, parabolas, strict=True))
        return value, first, second


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


@lru_cache
def gauss_rule(points: int) -> tuple[Array, Array]:
    """Nodes and weights (points,) of Gauss's rule on −1 … 1."""
    rule = legendre.leggauss(points)
    for values in rule:
        values.setflags(write=False)
    return rule


LEAST = 4
"""Stations on the shortest piece, between whose ends trial functions hardly bend."""


@dataclass(frozen=True, slots=True, eq=False)
class Stations(Sealed):
    """Gauss stations along the span: ``per_piece`` on each piece between breakpoints, where the blade may change abruptly."""

    z: Array
    weight: Array
    breakpoints: Array
    per_piece: int

    @classmethod
    def between(cls, breakpoints: Array, per_piece: int) -> Stations:
        """Stations on every piece between ascending breakpoints (m)."""
        nodes, weights = gauss_rule(per_piece)
        half = 0.5 * np.diff(breakpoints)
        z = (breakpoints[:-1] + half)[:, None] + half[:, None] * nodes
        return cls(z.ravel(), (half[:, None] * weights).ravel(), breakpoints, per_piece)

    @classmethod
    def graded(cls, breakpoints: Array, order: int) -> Stations:
        """Stations for functions of ``order`` on the whole span: the fewer the shorter a piece is."""
        share = np.diff(breakpoints) / (breakpoints[-1] - breakpoints[0])
        pieces = [cls.between(breakpoints[k : k + 2], int(np.ceil(LEAST + order * part))) for k, part in enumerate(share)]
        z, weight = (np.concatenate([getattr(piece, name) for piece in pieces]) for name in ("z", "weight"))
        return cls(z, weight, breakpoints, 0)

    def integral_to_tip(self, values: Array) -> Array:
        """∫_z^L f dσ at every station, exact for f polynomial (degree < per_piece) on each piece."""
        per_piece = values.reshape(-1, self.per_piece)
        half = 0.5 * np.diff(self.breakpoints)
        whole = (self.weight * values).reshape(per_piece.shape).sum(axis=1)
        beyond = np.append(np.cumsum(whole[::-1])[::-1][1:], 0.0)
        return (half[:, None] * (per_piece @ remaining_integrals(self.per_piece).T) + beyond[:, None]).ravel()


@lru_cache
def remaining_integrals(points: int) -> Array:
    """(points, points): ∫ from Gauss node q to 1 of the Lagrange polynomial of node j."""
    nodes, weights = gauss_rule(points)
    values = legendre.legvander(nodes, points)
    degree = np.arange(1, points)
    tail = np.column_stack([1.0 - nodes, (values[:, degree - 1] - values[:, degree + 1]) / (2 * degree + 1)])
    return sealed(np.asarray(tail @ (degree_norms(points)[:, None] * values[:, :points].T * weights)))


def degree_norms(points: int) -> Array:
    """(2k + 1)/2, the inverse squared norms of the Legendre polynomials k = 0 … points − 1."""
    return np.arange(points, dtype=np.float64) + 0.5
