"""Integration through walls whose properties follow a power of the depth, whatever the power, and rules for such weights."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed

Array = NDArray[np.float64]

STEP = 1.0 / 20.0
REACH = 3.4
"""Of the double-exponential rule: 137 places; exponents from 10⁻⁶ to 10³ leave nothing but round-off, 10⁴ leaves 10⁻¹³."""


@dataclass(frozen=True, slots=True, eq=False)
class DepthRule(Sealed):
    """Places through a ply."""

    place: Array
    """(n,): from −1 at the inner face to 1 at the outer."""
    weight: Array
    """(n,), of sum 2."""
    volume: Array
    """(n,): share of the outer material."""


@lru_cache(maxsize=64)
def power_rule(exponent: float, start: float = 0.0, end: float = 1.0, step: float = STEP) -> DepthRule:
    """For integrals of smooth functions of the depth and of ξ to a power, with ξ from ``start`` to ``end`` through the ply.

    A power below 1 has unbounded slopes at one face, a large one a thin layer at the other: both are smooth in the variable of the
    double-exponential rule (Takahasi and Mori, Publ. RIMS 9, 1974).
    """
    count = int(np.ceil(REACH / step))
    t = step * np.arange(-count, count + 1)
    bent = 0.5 * np.pi * np.sinh(t)
    inside, left = 1.0 / (1.0 + np.exp(-2.0 * bent)), 1.0 / (1.0 + np.exp(2.0 * bent))
    weight = 0.25 * np.pi * np.cosh(t) / np.cosh(bent) ** 2
    weight *= 2.0 / weight.sum()
    from_start = left * start + inside * end
    from_end = left * (1.0 - start) + inside * (1.0 - end)
    return DepthRule(inside - left, weight, _power(from_start, from_end, exponent))


def _power(share: Array, rest: Array, exponent: float) -> Array:
    """ξ to a power, where ξ = ``share`` and 1 − ξ = ``rest``, each to full precision."""
    with np.errstate(divide="ignore"):
        logarithm = np.where(share < 0.5, np.log(share), np.log1p(-rest))
    return np.exp(exponent * logarithm)


def gauss_rule_of_weight(places: Array, weights: Array, count: int) -> tuple[Array, Array]:
    """(count,) each: places and weights of Gauss's rule for a positive weight that is given as a finer rule.

    By Lanczos' method on the polynomials of the fine rule, with full reorthogonalisation (Golub and Welsch, Mathematics of
    Computation 23, 1969): exact to degree 2 count − 1.
    """
    total = weights.sum()
    basis = [np.sqrt(weights / total)]
    tridiagonal = np.zeros((count, count))
    for k in range(count):
        onward = places * basis[k]
        tridiagonal[k, k] = basis[k] @ onward
        for _ in range(2):
            onward = onward - sum((each @ onward) * each for each in basis)
        if k + 1 < count:
            norm = float(np.linalg.norm(onward))
            tridiagonal[k, k + 1] = tridiagonal[k + 1, k] = norm
            basis.append(onward / norm)
    found, vectors = np.linalg.eigh(tridiagonal)
    return found, total * vectors[0] ** 2


def interpolating_rule(places: Array, weights: Array, count: int) -> tuple[Array, Array]:
    """(count,) each: a rule on −1 … 1 for a weight of any sign that is given as a finer rule, exact to degree count − 1.

    At Gauss's places, each Lagrange polynomial through which is integrated by its Legendre coefficients.
    """
    found, usual = np.polynomial.legendre.leggauss(count)
    degree = np.arange(count)
    moments = np.polynomial.legendre.legvander(places, count - 1).T @ weights
    values = np.polynomial.legendre.legvander(found, count - 1)
    return found, usual * (values @ ((degree + 0.5) * moments))
