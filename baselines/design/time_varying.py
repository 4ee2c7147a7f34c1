"""Riccati recursions of control and filtering over an episode: the sampled equations instant by instant, of many plants at once.

With plants, costs and covariances that may change from one control interval to the next, backward from the end

    K = (R + BᵀP⁺B)⁻¹ (BᵀP⁺A + Nᵀ),        P = AᵀP⁺A + Q − (AᵀP⁺B + N) K,        u = −K x̂,

and forward from the covariance S of what is not known at the start

    L = SCᵀ(CSCᵀ + V)⁻¹,        S⁺ = A (S − L C S) Aᵀ + W,        x̂ ← x̂ + L (y − C x̂).

Together they cost least over the episode, in the mean, under white noise (Åström, Introduction to Stochastic Control Theory, 1970,
ch. 8; Anderson and Moore, Optimal Filtering, 1979, ch. 3). Over a long one they tend to the gains of ``riccati``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.design.riccati import Array


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """One control interval of G plants of s states: all arrays may have a leading axis (G,)."""

    A: Array
    """(…, s, s)."""
    B: Array
    """(…, s, m)."""
    C: Array
    """(…, p, s)."""
    Q: Array
    N: Array
    R: Array
    """The cost xᵀQx + 2xᵀNu + uᵀRu of the interval; R (…, m, m) positive definite."""
    W: Array
    """(…, s, s): covariance of what is added to the state in the interval."""
    V: Array
    """(…, p, p): of one sample's noise, positive definite."""


def regulator_gains(last_first: Iterable[Stage], final: Array) -> tuple[Array, Array]:
    """K (T, …, m, s), the first interval's first, and the first P (…, s, s), from stages in reverse; ``final`` P is the end's."""
    P, gains = final, []
    for stage in last_first:
        with_B = P @ stage.B
        cross = _transposed(stage.A) @ with_B + stage.N
        gain = np.linalg.solve(stage.R + _transposed(stage.B) @ with_B, _transposed(cross))
        P = _symmetric(_transposed(stage.A) @ (P @ stage.A) + stage.Q - cross @ gain)
        gains.append(gain.astype(np.float32))
    return np.stack(gains[::-1]), P


def filter_gains(stages: Iterable[Stage], initial: Array) -> tuple[Array, Array]:
    """L (T, …, s, p), and the S (…, s, s) that is left, from stages in order and the ``initial`` S, before the first reading."""
    S, gains = initial, []
    for stage in stages:
        seen = stage.C @ S
        gain = _transposed(np.linalg.solve(seen @ _transposed(stage.C) + stage.V, seen))
        S = _symmetric(stage.A @ (S - gain @ seen) @ _transposed(stage.A) + stage.W)
        gains.append(gain.astype(np.float32))
    return np.stack(gains), S


def _transposed(matrix: NDArray[np.floating[Any]]) -> NDArray[np.floating[Any]]:
    return matrix.swapaxes(-1, -2)


def _symmetric(matrix: Array) -> Array:
    return np.asarray(0.5 * (matrix + _transposed(matrix)))
