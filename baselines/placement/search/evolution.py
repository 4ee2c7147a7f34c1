"""CMA-ES (Hansen 2016) by the package ``cma``."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from baselines.placement.search.placement import Recorder
from beamenv.configuration import Count, Positive, Whole, configuration

Array = NDArray[np.float64]


@configuration("Evolution")
class Evolution:
    """Covariance-matrix adaptation on positions, repaired before they are evaluated."""

    population: Annotated[int, Count(2)] = 20
    step: Positive = 0.25
    """First standard deviation, as a share of the patches' room."""
    evaluations: Whole = 3000

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Search from the start."""
        import cma

        bounds = recorder.problem.bounds
        width = max(bounds.high - bounds.low, bounds.length)
        options = {
            "popsize": self.population,
            "maxfevals": self.evaluations,
            "seed": np.nan,  # leaves NumPy's global generator alone
            "randn": lambda *shape: generator.standard_normal(shape),
            "tolfun": 1e-10 * recorder.cost,
            "verbose": -9,
        }
        # cma has no search in one dimension: a second coordinate that nothing depends on
        strategy = cma.CMAEvolutionStrategy(np.append((start - bounds.low) / width, 0.0), self.step, options)
        spent = recorder.evaluations
        while not strategy.stop():
            drawn = np.array(strategy.ask())
            wanted = bounds.low + width * drawn[:, :-1]
            layouts = bounds.repaired(wanted)
            astray = ((np.sort(wanted, axis=1) - layouts) ** 2).sum(axis=1) / width**2  # without it the search drifts off
            strategy.tell(list(drawn), list(recorder.costs(layouts) * (1.0 + astray)))
            recorder.note((recorder.evaluations - spent) / self.evaluations)
