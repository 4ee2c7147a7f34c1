"""What the runs of one training come to together: mean and spread, with intervals that resample runs and seeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Estimate, Evaluation
from baselines.evaluation.metrics import finite
from baselines.evaluation.statistics import CONFIDENCE
from train.benchmark import statistics
from train.benchmark.table import UNSTABLE

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Spread:
    """Of the means of K runs."""

    deviation: float
    """Standard deviation (divisor K − 1); infinite if a run is."""
    least: float
    greatest: float


@dataclass(frozen=True, slots=True, eq=False)
class Runs:
    """K runs of one training, evaluated on the same N seeds."""

    name: str
    evaluations: Mapping[str, Evaluation]
    """By the number of the run."""

    @property
    def first(self) -> Evaluation:
        """That of the first run: seeds and J without control are the same for all."""
        return next(iter(self.evaluations.values()))

    def estimates(self) -> dict[str, Estimate]:
        """Means over runs and seeds by name, the relative cost first; intervals resample both, crossed."""
        cost = np.stack([each.judged_cost for each in self.evaluations.values()])
        metrics = {
            name: np.stack([getattr(each.metrics, name) for each in self.evaluations.values()])
            for name in self.first.metrics.__dataclass_fields__
        }
        together = {"relative_cost": statistics.relative_cost(cost, self.first.uncontrolled)}
        return together | {"unstable": self.unstable, **{name: statistics.mean(values) for name, values in metrics.items()}}

    @property
    def unstable(self) -> Estimate:
        """Share of episodes that are, as the benchmark counts them."""
        cost = np.stack([each.metrics.cost for each in self.evaluations.values()])
        return statistics.mean((cost > UNSTABLE * self.first.uncontrolled).astype(float))

    def spread(self) -> dict[str, Spread]:
        """How far the runs' own values lie from each other, by name."""
        each = [Runs(self.name, {run: found}).estimates() for run, found in self.evaluations.items()]
        return {name: _spread([own[name].value for own in each]) for name in each[0]}

    def to_dict(self) -> dict[str, Any]:
        """Everything but the time series, as JSON can hold it: together, as of one evaluation, and run by run."""
        found = {name: _told(each) for name, each in self.estimates().items()}
        spread = {
            name: {"deviation": finite(each.deviation), "least": finite(each.least), "greatest": finite(each.greatest)}
            for name, each in self.spread().items()
        }
        return {
            "controller": self.name,
            "confidence": CONFIDENCE,
            "estimates": found,
            "spread": spread,
            "seeds": list(self.first.episodes.seeds),
            "runs": {run: each.to_dict() for run, each in self.evaluations.items()},
        }

    def one_to_dict(self) -> dict[str, Any]:
        """The same of the first run alone."""
        content = self.first.to_dict()
        return {**content, "estimates": {**content["estimates"], "unstable": _told(self.unstable)}}


def _told(estimate: Estimate) -> dict[str, float | None]:
    return {"value": finite(estimate.value), "low": finite(estimate.low), "high": finite(estimate.high)}


def _spread(values: list[float]) -> Spread:
    whole = bool(np.isfinite(values).all())
    return Spread(float(np.std(values, ddof=1)) if whole else float("inf"), min(values), max(values))
