"""Sequential quadratic programming with exact slopes: from one layout, from many, or from where another search ended."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from baselines.placement.search.placement import Recorder
from beamenv.configuration import Positive, Whole, configuration

Array = NDArray[np.float64]


@configuration("SequentialQuadratic")
class SequentialQuadratic:
    """SciPy's SLSQP (Kraft 1988) on the patches' positions, which may touch but not overlap."""

    iterations: Whole = 100
    tolerance: Positive = 1e-10
    """Relative change of the cost at which it stops."""

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Descend from the start to the nearest minimum; the generator does not matter."""
        self.descend(recorder, start, report=True)
        recorder.note(1.0)

    def descend(self, recorder: Recorder, start: Array, report: bool = False) -> None:
        """Descend from a layout (count,), m; ``report`` every iteration."""
        bounds = recorder.problem.bounds
        start_cost = float(recorder.costs(start[None])[0])
        length, count = bounds.length, bounds.count
        done = 0

        def scaled(x: Array) -> tuple[float, Array]:
            cost, slopes = recorder.cost_and_slopes(x * length)
            return cost / start_cost, slopes * length / start_cost

        def after_iteration(_: Array) -> None:
            nonlocal done
            done += 1
            recorder.note(done / self.iterations)

        apart = np.eye(count, k=1)[:-1] - np.eye(count)[:-1]
        spacing = {"type": "ineq", "fun": lambda x: apart @ x - 1.0, "jac": lambda x: apart}
        result = minimize(
            scaled,
            start / length,
            jac=True,
            method="SLSQP",
            bounds=[(bounds.low / length, bounds.high / length)] * count,
            constraints=[spacing] if count > 1 else [],
            options={"maxiter": self.iterations, "ftol": self.tolerance},
            callback=after_iteration if report else None,
        )
        recorder.costs(bounds.repaired(result.x * length)[None])


@configuration("MultiStart")
class MultiStart:
    """SQP from the start and from the best of many random layouts."""

    candidates: Whole = 300
    """Random layouts evaluated."""
    starts: Whole = 10
    """The best of them, from each of which SQP descends."""
    descent: SequentialQuadratic = SequentialQuadratic()

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Search."""
        layouts = recorder.problem.bounds.random(generator, self.candidates)
        order = np.argsort(recorder.costs(layouts), kind="stable")
        recorder.note(0.2)
        chosen = [start, *layouts[order[: self.starts]]]
        for k, layout in enumerate(chosen):
            self.descent.descend(recorder, layout)
            recorder.note(0.2 + 0.8 * (k + 1) / len(chosen))
