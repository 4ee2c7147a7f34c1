"""Gauss stations along the span, at which a blade's energies are integrated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed, sealed

Array = NDArray[np.float64]


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
