"""OKID: Markov parameters of plant and noise from a record of any input (Juang, Phan, Horta and Longman, J. Guidance, Control and
Dynamics 16(2), 1993).

Least squares find the Markov parameters of an observer that forgets, q rows of them however slowly the plant's own die away:
y_k = Σ_{i ≤ q} (β_i u_{k−i} + α_i y_{k−i}) + e_k. Those of the plant and of the noise follow by recursion. ``control.markov`` asks
for those of the plant itself, which at 1 % damping are thousands a channel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.identification.measurement import Measurement
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

MOST_LAGS = 80
ROWS_PER_NUMBER = 5
"""Rows there must be for each number that is estimated of a reading."""
AT_ONCE = 8192


@dataclass(frozen=True, slots=True, eq=False)
class Observer(ReadOnly):
    """Markov parameters of an observer."""

    of_voltages: Array
    """β (q, p, m)."""
    of_readings: Array
    """α (q, p, p)."""
    covariance: Array
    """(p, p) of what it leaves."""

    def markov(self, count: int) -> Array:
        """(count, p, m + p): C Aᵏ [B K] from k = 0 on."""
        q, whole = len(self.of_voltages), np.concatenate([self.of_voltages, self.of_readings], axis=2)
        found = np.zeros((count, *whole.shape[1:]))
        found[: min(q, count)] = whole[:count]
        for k in range(1, count):
            back = min(k, q)
            found[k] += np.einsum("ipr,irc->pc", self.of_readings[:back], found[k - back : k][::-1])
        return found


def observer(measured: Measurement, lags: int | None = None) -> Observer:
    """The observer of as many ``lags`` as Akaike's criterion wants; ``ValueError`` for a measurement too short for any."""
    each = np.hstack([measured.voltages, measured.readings])
    width, most = each.shape[1], lags or largest_lag(measured)
    if most < 2:
        needed = ROWS_PER_NUMBER * 2 * width
        raise ValueError(f"the measurement has {len(measured)} rows to learn from, but must have at least {needed}.")
    moments, crossed, squares, rows = _sums(each, measured.readings, most)
    choices = [lags] if lags else sorted({most, *(q for q in (2, 4, 8, 12, 20, 30, 40, 60) if q < most)})
    solved = [_solved(moments, crossed, squares, rows, q * width) for q in choices]
    criteria = [rows * np.linalg.slogdet(left)[1] + 2.0 * each.size for each, left in solved]
    weights, covariance = solved[int(np.argmin(criteria))]
    return _observer(weights, covariance, measured.voltages.shape[1])


def largest_lag(measured: Measurement) -> int:
    """How many rows back the measurement is long enough for."""
    width = measured.voltages.shape[1] + measured.readings.shape[1]
    return min(MOST_LAGS, len(measured) // (ROWS_PER_NUMBER * width))


def _sums(each: Array, readings: Array, lags: int) -> tuple[Array, Array, Array, int]:
    """Of regressors [z_{k−1}, z_{k−2}, …] with themselves and with readings, and of these."""
    size, p = lags * each.shape[1], readings.shape[1]
    moments, crossed, squares = np.zeros((size, size)), np.zeros((size, p)), np.zeros((p, p))
    for first in range(lags, len(each), AT_ONCE):
        last = min(first + AT_ONCE, len(each))
        back = np.hstack([each[first - i : last - i] for i in range(1, lags + 1)])
        moments += back.T @ back
        crossed += back.T @ readings[first:last]
        squares += readings[first:last].T @ readings[first:last]
    return moments, crossed, squares, len(each) - lags


def _solved(moments: Array, crossed: Array, squares: Array, rows: int, size: int) -> tuple[Array, Array]:
    """Weights (size, p) of the first regressors, and the covariance (p, p) of what they leave."""
    ridge = 1e-10 * np.trace(moments) / len(moments) * np.eye(size)
    weights = np.linalg.solve(moments[:size, :size] + ridge, crossed[:size])
    left = squares - weights.T @ crossed[:size]
    return weights, 0.5 * (left + left.T) / rows


def _observer(weights: Array, covariance: Array, m: int) -> Observer:
    p = len(covariance)
    by_lag = weights.reshape(-1, m + p, p).swapaxes(1, 2)
    return Observer(by_lag[:, :, :m].copy(), by_lag[:, :, m:].copy(), covariance)
