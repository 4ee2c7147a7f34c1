"""Estimates with bootstrap intervals: over seeds, or over training runs and seeds that are crossed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from baselines.design.controller import Array
from beamenv.configuration.read_only import Sealed, sealed

RESAMPLES = 2000
CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True)
class Estimate:
    """A mean over seeds and its percentile bootstrap interval."""

    value: float
    low: float
    high: float


def interval(value: float, resampled: Array, confidence: float = CONFIDENCE) -> Estimate:
    """A value with the percentile interval of its resampled ones."""
    low, high = np.quantile(resampled, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence], method="nearest")
    return Estimate(float(value), float(low), float(high))


@lru_cache(maxsize=8)
def paired_draws(seeds: int) -> NDArray[np.intp]:
    """(R, N): draws with replacement of N seeds, the same at every call, so that controllers are resampled in pairs."""
    return sealed(_draws(seeds, seeds, RESAMPLES))


@dataclass(frozen=True, slots=True, eq=False)
class Resamples(Sealed):
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
    of_runs, of_seeds = (_draws((index, size), size, count) for index, size in enumerate((runs, seeds)))
    return Resamples(of_runs, of_seeds, _counts(of_runs), _counts(of_seeds))


def _draws(entropy: int | tuple[int, int], size: int, count: int) -> NDArray[np.intp]:
    return np.random.default_rng(entropy).integers(size, size=(count, size))


def _counts(drawn: NDArray[np.intp]) -> Array:
    return np.stack([np.bincount(row, minlength=drawn.shape[1]) for row in drawn]).astype(float)
