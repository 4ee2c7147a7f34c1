"""What the numbers of the benchmark are, and by which rules: one text for tables and pages."""

from __future__ import annotations

from baselines.evaluation.statistics import CONFIDENCE, RESAMPLES
from train.benchmark import failures, score
from train.benchmark.table import UNSTABLE, BenchmarkTable
from train.controllers.tiers import tiers_told


def legend(table: BenchmarkTable) -> str:
    """Paragraphs on all of it."""
    return "\n\n".join(f"{term}: {meaning}" for term, meaning in (terms(table) | details()).items())


def terms(table: BenchmarkTable) -> dict[str, str]:
    """What the words mean that a reader needs, in order."""
    first, last = table.configuration["seeds"]
    return {
        "J": "the cost of an episode, ∫(xᵀQx + uᵀRu) dt: vibration energy plus actuator energy. Lower is better.",
        "J₀": f"J without control on the same episodes: {last - first + 1} held-out random seeds, {first} to {last}, equal for "
        "every controller.",
        "J / J₀": "ratio of the means over seeds and training runs: 1 is as good as no control.",
        "[low, high]": f"{100 * CONFIDENCE:.0f} % bootstrap interval, {RESAMPLES} resamples of seeds and of training runs. Two "
        "controllers are compared in pairs, seed by seed; one is below another where the whole interval of the difference is "
        "below zero.",
        "unstable": f"an episode in which the blade fails under the controller, or J > {UNSTABLE:g} J₀.",
        "tier": f"{tiers_told()} The best of a tier is that of all its kinds.",
        "score": score.RULE,
    }


def details() -> dict[str, str]:
    """What only who looks closer needs."""
    return {
        "Score, in detail": score.DETAILS,
        "Saved and lost blades": failures.RULE,
        "IQM": "interquartile mean of J / J₀, seed by seed and run by run: the mean of the middle half.",
        "P(J < LQG's)": "probability that J is below LQG's on the same seed; ties count half.",
        "Settling, peaks, effort": "means over episodes.",
    }
