"""What the numbers of the benchmark are, and by which rules: one text for tables and pages."""

from __future__ import annotations

from baselines.evaluation.statistics import CONFIDENCE, RESAMPLES
from train.benchmark import failures, score
from train.benchmark.table import UNSTABLE, BenchmarkTable
from train.controllers.tiers import tiers_told


def legend(table: BenchmarkTable) -> str:
    """Paragraphs on the estimates, on blades that fail, on the score, and on tiers."""
    return "\n\n".join([estimates(table), failures.RULE, score.RULE, tiers()])


def estimates(table: BenchmarkTable) -> str:
    """What each column is, and what its interval."""
    first, last = table.configuration["seeds"]
    return (
        f"J₀ is J without control on the same episodes: {last - first + 1} held-out seeds, {first} to {last}, equal for every "
        "controller. J / J₀: ratio of the means over seeds and training runs. IQM: interquartile mean of J / J₀, seed by seed and "
        f"run by run. Brackets: {100 * CONFIDENCE:.0f} % bootstrap intervals, {RESAMPLES} resamples of seeds and of training runs. "
        "P(J < LQG's): probability of improvement, ties half. An episode is unstable if the blade fails under the controller, or "
        f"if J > {UNSTABLE:g} J₀. Settling, peaks and effort are means over episodes."
    )


def tiers() -> str:
    """What the tiers are, and how they are compared."""
    return f"{tiers_told()} The best of a tier is that of all its kinds."
