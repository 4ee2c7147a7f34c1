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
from train.shared.columns import EVALUATION

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
        return together | {name: statistics.mean(values) for name, values in metrics.items()}

    def spread(self) -> dict[str, Spread]:
        """How far the runs' own values lie from each other, by name."""
        return {name: _spread([each.estimates()[name].value for each in self.evaluations.values()]) for name in self.estimates()}

    def cells(self) -> list[str]:
        """A row of a table: name, then every column."""
        found = self.estimates()
        return [f"mean of {len(self.evaluations)} runs", *(column.text(found[column.name]) for column in EVALUATION)]

    @property
    def sentence(self) -> str:
        """Mean and spread of the relative cost."""
        value, spread = self.estimates()["relative_cost"].value, self.spread()["relative_cost"]
        return (
            f"J / J without control over {len(self.evaluations)} runs: mean {value:.3f}, standard deviation "
            f"{spread.deviation:.3f}, {spread.least:.3f} to {spread.greatest:.3f}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Everything but the time series, as JSON can hold it: together, as of one evaluation, and run by run."""
        found = {
            name: {"value": finite(each.value), "low": finite(each.low), "high": finite(each.high)}
            for name, each in self.estimates().items()
        }
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


def _spread(values: list[float]) -> Spread:
    whole = bool(np.isfinite(values).all())
    return Spread(float(np.std(values, ddof=1)) if whole else float("inf"), min(values), max(values))
