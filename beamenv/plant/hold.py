"""Linear systems whose inputs are held: the exact step and the exact integral of a quadratic cost, over an interval of any length.

With z = [x; u] and u held, ż = M z, M = [[A, B], [0, 0]]. Over an interval t

    Φ(t) = exp(M t),        P(t) = ∫₀ᵗ Φ(s)ᵀ W Φ(s) ds .

Both are those of a short step h = t/2ᵏ, doubled k times:

    Φ(2h) = Φ(h)²,        P(2h) = P(h) + Φ(h)ᵀ P(h) Φ(h),

sums of positive semidefinite parts, in which nothing cancels. (Van Loan's single exponential, IEEE Trans. Automatic Control 23,
1978, has exp(−Aᵀt) beside exp(At) and P as their product: digits go as exp(ζωt) grows, all of them by ζωt = 40.) What is doubled is
Φ − I, by (Φ − I) ← (Φ − I)² + 2 (Φ − I): slow states beside fast ones move little in h, and I + little keeps few digits of little.

Over the short step Φ is Taylor's polynomial and P Gauss's quadrature of it, both to rounding. Φ is linear in B and P quadratic, so
the step is chosen by A alone, and the units of inputs do not matter.
"""

from __future__ import annotations

from math import ceil, factorial, inf, log2

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHORT = 0.125
"""Largest ‖A‖₁h of a step that is not made of shorter ones."""

DEGREE = 10
"""Of Taylor's polynomial: relative to Φ − I it leaves SHORT¹⁰/11! = 2·10⁻¹⁷."""

POINTS = 5
"""Of Gauss's quadrature: it leaves 4·10⁻¹⁹ of the weight of states, 10⁻¹⁶ of what inputs add through the states."""

AT_ONCE = 2**16
"""Numbers that the powers of M may take at a time, in banks of plants: as many as stay in a processor's cache."""


def _taylor() -> tuple[Array, Array]:
    """Rows (POINTS + 1, DEGREE) of τᵏ/k! at Gauss's points of the unit interval and at its end; their weights (POINTS, 1, 1)."""
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    instants = np.append(0.5 + 0.5 * points, 1.0)
    degrees = np.arange(1, DEGREE + 1)
    return instants[:, None] ** degrees / [factorial(k) for k in degrees], 0.5 * weights[:, None, None]


_TAYLOR, _WEIGHTS = _taylor()


def hold(A: Array, B: Array, interval: float) -> tuple[Array, Array]:
    """Transition (n, n) and input (n, m) of ẋ = A x + B u over an interval (s) in which u is held."""
    n, count = len(A), doublings(A, interval)
    change = _changes(_joined(A, B, interval * 0.5**count))[-1]
    for _ in range(count):
        change = 2.0 * change + change @ change
    return change[:n, :n] + np.eye(n), change[:n, n:]


def hold_with_cost(A: Array, B: Array, weight: Array, interval: float) -> tuple[Array, Array, Array]:
    """Transition (…, n, n), input (…, n, m) and cost P (…, s, s) over an interval (s); ``weight`` W (…, s, s), s = n + m."""
    n, count = A.shape[-1], doublings(A, interval)
    step = interval * 0.5**count
    both = _short_step(_joined(A, B, step), weight * step)
    change, cost = both
    identity = np.eye(change.shape[-1])
    for _ in range(count):
        transition = change + identity
        moved = both @ transition
        change += moved[0]  # (Φ − I) Φ + (Φ − I)
        cost += transition.swapaxes(-1, -2) @ moved[1]
    return change[..., :n, :n] + identity[:n, :n], change[..., :n, n:], 0.5 * (cost + cost.swapaxes(-1, -2))


def hold_all_with_cost(A: Array, B: Array, weight: Array, interval: float) -> tuple[Array, Array, Array]:
    """As ``hold_with_cost`` each of (K, …): those together that are halved equally often, but no more than a cache holds."""
    counts, most = [doublings(each, interval) for each in A], max(1, AT_ONCE // (DEGREE * weight[0].size))
    found = np.empty_like(A), np.empty_like(B), np.empty_like(weight)
    for count in sorted(set(counts)):
        alike = [index for index, each in enumerate(counts) if each == count]
        for few in (alike[start : start + most] for start in range(0, len(alike), most)):
            for every, part in zip(found, hold_with_cost(A[few], B[few], weight[few], interval), strict=True):
                every[few] = part
    return found


def doublings(A: Array, interval: float) -> int:
    """How often the interval is to be halved for A (…, n, n), the same for all."""
    rate = float(np.abs(A).sum(axis=-2).max()) * interval
    return ceil(log2(rate / SHORT)) if SHORT < rate < inf else 0


def _joined(A: Array, B: Array, step: float) -> Array:
    """M h (…, s, s)."""
    n = A.shape[-1]
    size = n + B.shape[-1]
    joined = np.zeros((*A.shape[:-2], size, size))
    joined[..., :n, :n], joined[..., :n, n:] = A, B
    joined *= step
    return joined


def _changes(joined: Array) -> Array:
    """Φ − I (…, POINTS + 1, s, s) at Gauss's points of the short step and at its end, from M h."""
    shape, size = joined.shape[:-2], joined.shape[-1]
    powers = np.empty((*shape, DEGREE, size, size))
    powers[..., 0, :, :], known = joined, 1
    while known < DEGREE:
        following = powers[..., known : 2 * known, :, :]
        np.matmul(powers[..., known - 1, None, :, :], powers[..., : following.shape[-3], :, :], out=following)
        known *= 2
    return (_TAYLOR @ powers.reshape(*shape, DEGREE, -1)).reshape(*shape, -1, size, size)


def _short_step(joined: Array, weight: Array) -> Array:
    """Φ − I and P (2, …, s, s) of M h and W h."""
    changes = _changes(joined)
    inner = changes[..., :-1, :, :] + np.eye(joined.shape[-1])
    costs = inner.swapaxes(-1, -2) @ (_WEIGHTS * weight[..., None, :, :] @ inner)
    return np.stack([changes[..., -1, :, :], costs.sum(axis=-3)])
