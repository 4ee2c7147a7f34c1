"""Sampled models in continuous time: the very model at the samples, whatever is between."""

from __future__ import annotations

import warnings
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag, expm, logm, schur, solve_sylvester

from beamenv.plant.hold import hold

Array = NDArray[np.float64]

AGREES = 1e-7
"""Of its largest entry: how far what is sampled again may be from the model."""

_NEXT_TO_ZERO = 1e-13


class Continuous(NamedTuple):
    """ẋ = A x + B u, y = C x, which sampled with held inputs is the model."""

    A: Array
    """(n + q, n + q), 1/s."""
    B: Array
    """(n + q, k)."""
    C: Array
    """(p, n + q): the last q states are not read."""
    alternating: int
    """q: poles on the negative real axis, of which each has become two."""


def continuous(A: Array, B: Array, C: Array, interval: float) -> Continuous:
    """That of x⁺ = A x + B u, y = C x, sampled every ``interval`` s, A (n, n) and B (n, k), all of whose inputs are held.

    A pole z < 0 alternates from sample to sample, as no single pole in continuous time does: it becomes a pair at the Nyquist
    frequency, s = (ln|z| ± iπ)/Δt, with a further state that nothing drives at the samples and nothing reads. Raises ``ValueError``
    for poles at zero, which are delays, or others that no system in continuous time has.
    """
    form, basis, kept = schur(A, output="real", sort=lambda real, imag: not (imag == 0.0 and real < 0.0))
    n, q = len(A), len(A) - kept
    mix = solve_sylvester(form[:kept, :kept], -form[kept:, kept:], -form[:kept, kept:]) if 0 < q < n else np.zeros((kept, q))
    turn = basis @ np.block([[np.eye(kept), mix], [np.zeros((q, kept)), np.eye(q)]])  # A turn = turn diag(usual, alternating)
    usual, alternating = _logarithm(form[:kept, :kept]), _logarithm(-form[kept:, kept:])
    pair = np.block([[alternating, np.pi * np.eye(q)], [-np.pi * np.eye(q), alternating]])
    whole = block_diag(usual, pair) / interval
    back = np.vstack([np.linalg.inv(turn), np.zeros((q, n))])
    forth = block_diag(turn, np.eye(q))  # the model's own coordinates again, the further states behind them
    found = forth @ whole @ np.linalg.inv(forth)
    gamma = hold(found, np.eye(n + q), interval)[1]
    inputs = np.linalg.solve(gamma, forth @ back @ B)
    if not _agrees(found, inputs, A, B, interval):
        raise ValueError(
            "A has poles that no system in continuous time has, such as delays of whole samples at zero: leave these out."
        )
    return Continuous(found, inputs, np.hstack([C, np.zeros((len(C), q))]), q)


def _logarithm(A: Array) -> Array:
    """Real logarithm (k, k) of a matrix without poles on the negative axis; numbers that are none where it has none."""
    if not len(A):
        return np.zeros((0, 0))
    poles = np.abs(np.linalg.eigvals(A))
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of what is inexact: sampled again it is compared
        found = logm(A + (_NEXT_TO_ZERO * np.eye(len(A)) if poles.min() < _NEXT_TO_ZERO else 0.0))
    return np.asarray(found.real if np.abs(np.imag(found)).max() <= 1e-6 * max(np.abs(found).max(), 1.0) else found.real * np.nan)


def _agrees(found: Array, inputs: Array, A: Array, B: Array, interval: float) -> bool:
    """Whether the model comes out again when what was found is sampled."""
    if not (np.isfinite(found).all() and np.isfinite(inputs).all()):
        return False
    n = len(A)
    transition, driven = expm(found * interval), hold(found, inputs, interval)[1]
    off = np.abs(transition[:n, :n] - A).max(), np.abs(transition[:n, n:]).max(initial=0.0), np.abs(driven[:n] - B).max(initial=0.0)
    return bool(max(off[:2]) <= AGREES * np.abs(A).max() and off[2] <= AGREES * np.abs(B).max(initial=1e-300))
