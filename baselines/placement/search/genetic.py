"""The thesis' genetic algorithm: binary strings, one cutting position, bits that flip (§6.3), by pymoo."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from baselines.placement.search.placement import Recorder
from beamenv.blade.bounds import Bounds
from beamenv.configuration import Count, Share, Whole, configuration

Array = NDArray[np.float64]
Bits = NDArray[np.bool_]


@configuration("Genetic")
class Genetic:
    """Tournaments, crossover, mutation; the best of parents and children survive. Overlaps are repaired, not penalised."""

    population: Annotated[int, Count(2)] = 30
    crossover: Share = 0.7
    """Probability that two parents are crossed."""
    mutation: Share = 0.01
    """Probability that a bit flips."""
    generations: Whole = 50
    bits: Annotated[int, Count(1, 40)] = 12
    """Of each position: a third of a millimetre on the thesis' blade."""

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Search from a random population; the start takes no part."""
        bounds, known = recorder.problem.bounds, dict[bytes, float]()
        algorithm = self._algorithm(bounds, int(generator.integers(2**31)))
        for generation in range(self.generations):
            children = algorithm.ask()
            layouts = bounds.repaired(decoded(children.get("X"), bounds, self.bits))
            children.set("F", _costs(recorder, layouts, known)[:, None])
            algorithm.evaluator.eval(algorithm.problem, children)
            algorithm.tell(infills=children)
            recorder.note((generation + 1) / self.generations)

    def _algorithm(self, bounds: Bounds, seed: int) -> Any:
        from pymoo.algorithms.soo.nonconvex.ga import GA
        from pymoo.core.problem import Problem
        from pymoo.core.repair import Repair
        from pymoo.operators.crossover.pntx import SinglePointCrossover
        from pymoo.operators.mutation.bitflip import BitflipMutation
        from pymoo.operators.sampling.rnd import BinaryRandomSampling

        bits = self.bits

        class Apart(Repair):  # type: ignore[misc]
            def _do(self, problem: Any, X: Bits, **_: Any) -> Bits:
                return encoded(bounds.repaired(decoded(X, bounds, bits)), bounds, bits)

        algorithm = GA(
            pop_size=self.population,
            sampling=BinaryRandomSampling(),
            crossover=SinglePointCrossover(prob=self.crossover),
            mutation=BitflipMutation(prob=1.0, prob_var=self.mutation),
            repair=Apart(),
        )
        problem = Problem(n_var=bits * bounds.count, n_obj=1, vtype=bool, xl=0, xu=1)
        algorithm.setup(problem, termination=("n_gen", self.generations), seed=seed, verbose=False)
        return algorithm


def _costs(recorder: Recorder, layouts: Array, known: dict[bytes, float]) -> Array:
    """Costs (N,) of layouts (N, count), of which those that have died out before are ``known``: with one patch every second one."""
    names = [layout.tobytes() for layout in layouts]
    new = [k for k, name in enumerate(names) if name not in known]
    if new:
        known.update(zip([names[k] for k in new], recorder.costs(layouts[new]).tolist(), strict=True))
    return np.array([known[name] for name in names])


def decoded(strings: Bits, bounds: Bounds, bits: int) -> Array:
    """Positions (N, count), m, from bit strings (N, count · bits), most significant bit first."""
    words = np.asarray(strings, dtype=float).reshape(len(strings), bounds.count, bits)
    numbers = words @ 2.0 ** np.arange(bits)[::-1]
    return bounds.low + numbers * (bounds.high - bounds.low) / (2.0**bits - 1.0)


def encoded(positions: Array, bounds: Bounds, bits: int) -> Bits:
    """Bit strings (N, count · bits) nearest to positions (N, count), m."""
    width = max(bounds.high - bounds.low, np.finfo(float).tiny)
    numbers = np.rint((positions - bounds.low) / width * (2.0**bits - 1.0)).astype(np.int64)
    words = (numbers[..., None] >> np.arange(bits)[::-1]) & 1
    return words.reshape(len(positions), -1).astype(bool)
