"""What the benchmark estimates over training runs and seeds, all of it with intervals that resample both."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.evaluation.statistics import Estimate, Resamples, interval, resamples

Array = NDArray[np.float64]


def interquartile_mean(values: Any) -> Any:
    """Mean along the last axis of what a quarter cut off at either end leaves: robust, and yet made of half of the values."""
    values = np.asarray(values, dtype=np.float64)
    cut = values.shape[-1] // 4
    kept = np.partition(values, (cut, values.shape[-1] - cut - 1), axis=-1)[..., cut : values.shape[-1] - cut]
    return kept.mean(axis=-1)


def better(cost: Array, rival: Array) -> Array:
    """1 where the cost is below the rival's, ½ where they are equal: its mean is the probability of improvement."""
    return np.where(cost == rival, 0.5, (cost < rival).astype(float))


def mean(values: Array) -> Estimate:
    """Of ``values`` (K, N) over runs and seeds."""
    return interval(values.mean(), resamples(*values.shape).mean(values))


def pooled_interquartile_mean(values: Array) -> Estimate:
    """Interquartile mean of ``values`` (K, N), runs and seeds taken together."""
    return interval(interquartile_mean(values.ravel()), interquartile_mean(resamples(*values.shape).pooled(values)))


def relative_cost(cost: Array, uncontrolled: Array) -> Estimate:
    """Mean of ``cost`` (K, N) over that of ``uncontrolled`` (N,), seeds resampled in pairs."""
    drawn = resamples(*cost.shape)
    return interval(cost.mean() / uncontrolled.mean(), drawn.mean(cost) / _mean_of_seeds(uncontrolled, drawn))


def difference(cost: Array, rival: Array, uncontrolled: Array) -> Estimate:
    """Relative cost of one controller, (K, N), less that of a rival, (L, N), on the same seeds. Infinite less infinite is a tie."""
    ours, theirs = resamples(*cost.shape), resamples(*rival.shape)
    value = _less(np.array([cost.mean()]), np.array([rival.mean()]))[0] / uncontrolled.mean()
    return interval(value, _less(ours.mean(cost), theirs.mean(rival)) / _mean_of_seeds(uncontrolled, ours))


def ratio(cost: Array, rival: Array) -> Estimate:
    """Mean cost of one controller, (K, N), over that of a rival, (L, N), on the same seeds."""
    ours, theirs = resamples(*cost.shape), resamples(*rival.shape)
    return interval(cost.mean() / rival.mean(), ours.mean(cost) / theirs.mean(rival))


def _mean_of_seeds(values: Array, drawn: Resamples) -> Array:
    return np.asarray(drawn.seed_counts @ values / len(values))


def _less(cost: Array, rival: Array) -> Array:
    both = np.isinf(cost) & np.isinf(rival)
    return np.where(both, 0.0, np.where(both, 0.0, cost) - np.where(both, 0.0, rival))
