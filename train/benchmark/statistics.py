"""What the benchmark estimates over training runs and seeds, all of it with intervals that resample both."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.evaluation.statistics import CONFIDENCE, RESAMPLES, Estimate, Resamples, interval, paired_draws, resamples
from beamenv.configuration.read_only import sealed

Array = NDArray[np.float64]

DRAWS = 20_000
"""Resamples of a p value that is compared with 5 % over so many scenarios."""


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
    value = less(np.array([cost.mean()]), np.array([rival.mean()]))[0] / uncontrolled.mean()
    return interval(value, less(ours.mean(cost), theirs.mean(rival)) / _mean_of_seeds(uncontrolled, ours))


def doubt(cost: Array, rival: Array) -> float:
    """Two-sided p value of the difference of mean costs, (K, N) less (L, N), on the same seeds: twice the share of ``DRAWS``
    resamples in which it has not the sign that it has; the difference itself counts as one of them, so that it is never 0.
    """
    ours, theirs = resamples(*cost.shape, DRAWS), resamples(*rival.shape, DRAWS)
    sign = np.sign(less(np.array([cost.mean()]), np.array([rival.mean()]))[0])
    against = np.count_nonzero(less(ours.mean(cost), theirs.mean(rival)) * sign <= 0.0)
    return min(1.0, 2.0 * (1 + against) / (1 + DRAWS))


def rejected(doubts: Sequence[float], level: float = 1.0 - CONFIDENCE) -> list[bool]:
    """Which null hypotheses fall when all of them are judged together: Holm's method (Scandinavian Journal of Statistics 6, 1979),
    by which the chance that any true one falls is at most ``level``.
    """
    order, found = np.argsort(doubts, kind="stable"), [False] * len(doubts)
    for step, place in enumerate(order.tolist()):
        if doubts[place] > level / (len(doubts) - step):
            break
        found[place] = True
    return found


def scores(cost: Array, reference: Array, uncontrolled: Array, stratum: str = "") -> Array | None:
    """(1 + R,): how much of what can be gained is, (J₀ − J) / (J₀ − J of the reference), each a mean; and the same of R resamples.

    Of ``cost`` (K, N) and ``reference`` (1, N). 0 is no control and 1 the reference; nothing is clipped, and an infinite ``cost``
    has the score −∞. None where the reference breaks a blade, or gains nothing in some resample: then there is nothing to relate
    to.

    Seeds are drawn together for all scenarios and controllers, as all meet the same ones. Runs are drawn by ``stratum``: one for
    each scenario's own trainings, and the same one for all scenarios that the same runs are put through.
    """
    seeds = _seed_counts(cost.shape[1])
    without = _means(uncontrolled[None], seeds)
    reach = without - _means(reference, seeds)
    if not (np.isfinite(reach).all() and (reach > 0.0).all()):
        return None
    return np.asarray((without - _means(cost, seeds, run_counts(len(cost), stratum))) / reach)


def summary(found: Array) -> Estimate:
    """The estimate of a value and its resamples, (1 + R,)."""
    return interval(found[0], found[1:])


def over_scenarios(scored: Sequence[Array]) -> Array:
    """(1 + R,): interquartile mean over scenarios of what ``scores`` gives for each."""
    return np.asarray(interquartile_mean(np.stack(scored, axis=-1)))


@lru_cache(maxsize=256)
def run_counts(runs: int, stratum: str) -> Array:
    """(1 + R, runs): how often each run is drawn in a stratum's resamples, the first of which are the runs themselves."""
    drawn = np.random.default_rng([runs, *stratum.encode()]).integers(runs, size=(RESAMPLES, runs))
    return sealed(np.vstack([np.ones(runs), (drawn[:, :, None] == np.arange(runs)).sum(axis=1)]))


@lru_cache(maxsize=8)
def _seed_counts(seeds: int) -> Array:
    """(1 + R, N): the same of seeds."""
    drawn = [np.bincount(row, minlength=seeds) for row in paired_draws(seeds)]
    return sealed(np.vstack([np.ones(seeds), *drawn]).astype(float))


def _means(values: Array, seeds: Array, runs: Array | None = None) -> Array:
    """(1 + R,): means of resampled ``values`` (K, N); infinite where an infinite one was drawn."""
    infinite = np.isinf(values)
    each = np.ones((1, len(values))) if runs is None else runs
    total = ((each @ np.where(infinite, 0.0, values)) * seeds).sum(axis=1)
    lost = ((each @ infinite.astype(float)) * seeds).sum(axis=1) > 0.0
    return np.asarray(np.where(lost, np.inf, total / values.size))


def _mean_of_seeds(values: Array, drawn: Resamples) -> Array:
    return np.asarray(drawn.seed_counts @ values / len(values))


def less(cost: Array, rival: Array) -> Array:
    """The one less the other; infinite less infinite is a tie."""
    both = np.isinf(cost) & (cost == rival)
    return np.where(both, 0.0, np.where(both, 0.0, cost) - np.where(both, 0.0, rival))
