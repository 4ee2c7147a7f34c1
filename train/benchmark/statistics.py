"""Estimates over training runs and seeds, with bootstrap intervals that resample both."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Estimate

Array = NDArray[np.float64]

RESAMPLES = 2000
CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True, eq=False)
class Resamples:
    """R draws with replacement of K runs and N seeds, each for itself.

    Every run meets the same seeds, so that runs and seeds are crossed: this is the pigeonhole bootstrap (Owen, Annals of Applied
    Statistics 1, 2007), never narrower than the stratified one of Agarwal et al. (NeurIPS 2021), whose seeds are each run's own.
    Draws of N seeds are always the same ones: controllers are compared in pairs.
    """

    runs: NDArray[np.intp]
    """(R, K)."""
    seeds: NDArray[np.intp]
    """(R, N)."""
    run_counts: Array
    """(R, K): how often each run was drawn."""
    seed_counts: Array
    """(R, N)."""

    def mean(self, values: Array) -> Array:
        """(R,): means of resampled ``values`` (K, N); infinite where an infinite one was drawn."""
        infinite = np.isinf(values)
        total = ((self.run_counts @ np.where(infinite, 0.0, values)) * self.seed_counts).sum(axis=1)
        lost = ((self.run_counts @ infinite.astype(float)) * self.seed_counts).sum(axis=1) > 0.0
        return np.where(lost, np.inf, total / values.size)

    def pooled(self, values: Array) -> Array:
        """(R, K · N): the resampled values themselves."""
        return values[self.runs[:, :, None], self.seeds[:, None, :]].reshape(len(self.runs), -1)


@lru_cache(maxsize=8)
def resamples(runs: int, seeds: int, count: int = RESAMPLES) -> Resamples:
    """``count`` draws of runs and seeds, the same at every call."""
    drawn = [np.random.default_rng((index, size)).integers(size, size=(count, size)) for index, size in enumerate((runs, seeds))]
    counts = [np.stack([np.bincount(row, minlength=each.shape[1]) for row in each]).astype(float) for each in drawn]
    return Resamples(*drawn, *counts)


def interquartile_mean(values: Any) -> Any:
    """Mean along the last axis of what a quarter cut off at either end leaves: robust, and yet made of half of the values."""
    values = np.asarray(values, dtype=np.float64)
    cut = values.shape[-1] // 4
    kept = np.partition(values, (cut, values.shape[-1] - cut - 1), axis=-1)[..., cut : values.shape[-1] - cut]
    return kept.mean(axis=-1)


def better(cost: Array, rival: Array) -> Array:
    """1 where the cost is below the rival's, ½ where they are equal: its mean is the probability of improvement."""
    return np.where(cost == rival, 0.5, (cost < rival).astype(float))


def interval(value: float, resampled: Array) -> Estimate:
    """A value with the percentile interval of its resampled ones."""
    tail = 0.5 * (1.0 - CONFIDENCE)
    low, high = np.quantile(resampled, [tail, 1.0 - tail], method="nearest")
    return Estimate(float(value), float(low), float(high))


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
