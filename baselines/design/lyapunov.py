"""Discrete Lyapunov equations by doubling: an algorithm on matrices."""

from __future__ import annotations

import numpy as np

from baselines.design.controller import Array

_FORGOTTEN = 1e-20
"""Of what was there at the start, when all of it counts as gone; the inverse says that it grows."""

_DOUBLINGS = 50
"""2⁵⁰ intervals: a loop that needs longer counts as unstable."""


def accumulated(transition: Array, added: Array) -> Array | None:
    """Σ = Φ Σ Φᵀ + N as the sum of Φᵏ N Φᵏᵀ, twice as many terms at every step; None if it has no end. N (n, n) is symmetric.

    Smith, SIAM J. Applied Mathematics 16, 1968: no eigenvalues are needed to see that a loop is unstable.
    """
    power, total = transition, added
    for _ in range(_DOUBLINGS):
        total = total + power @ total @ power.T
        power = power @ power
        size = float(np.abs(power).max(initial=0.0))
        if size < _FORGOTTEN:
            return np.asarray(0.5 * (total + total.T))
        if not size < 1.0 / _FORGOTTEN:
            return None
    return None
