"""One interface to every search for positions."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.placement.cost.controllability import check_reach
from baselines.placement.cost.problem import PlacementProblem
from baselines.placement.search.evolution import Evolution
from baselines.placement.search.genetic import Genetic
from baselines.placement.search.grid import Grid
from baselines.placement.search.placement import Placement, Progress, Recorder
from baselines.placement.search.sqp import MultiStart, SequentialQuadratic
from beamenv.configuration import Count, Flag, Instance, Refused, checked, unknown_name

Array = NDArray[np.float64]


class Method(Protocol):
    """A search: it evaluates layouts through the recorder, which remembers the best."""

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Search from ``start`` (count,), m, which has been evaluated already."""
        ...


def is_search(value: Any) -> bool:
    """Whether it is a ``Method``: an object, not a class of them."""
    return callable(getattr(value, "run", None)) and not isinstance(value, type)


@dataclass(frozen=True, slots=True)
class InTurn:
    """One search after another, each from the best so far (thesis Fig. 6.3: GA, then SQP).

    Raises ``ValueError`` for stages that are not one or more searches.
    """

    stages: tuple[Method, ...]

    def __post_init__(self) -> None:
        if not (isinstance(self.stages, (tuple, list)) and self.stages and all(map(is_search, self.stages))):
            raise Refused("stages", self.stages, "one or more searches, in a tuple")
        object.__setattr__(self, "stages", tuple(self.stages))

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Search."""
        recorder.share = 1.0 / len(self.stages)
        for stage in self.stages:
            stage.run(recorder, recorder.positions, generator)
            recorder.begun += recorder.share


METHODS: Mapping[str, Method] = MappingProxyType(
    {
        "multistart": MultiStart(),
        "ga+sqp": InTurn((Genetic(), SequentialQuadratic())),
        "ga": Genetic(),
        "sqp": SequentialQuadratic(),
        "cma-es": Evolution(),
        "grid": Grid(),
    }
)
"""SQP from many starts, the thesis' way and its two halves, CMA-ES, and for one or two patches every layout."""


def place(
    problem: PlacementProblem,
    method: str | Method = "multistart",
    seed: int = 0,
    start: ArrayLike | None = None,
    progress: Progress | None = None,
    leave_unreached: bool = False,
) -> Placement:
    """Positions of least cost that a method finds, never dearer than its start; the same seed gives the same positions.

    ``start`` (count,), m, is uniform unless given. Raises ``ValueError`` for an unknown method, a start that is not feasible, or
    a blade with a mode that the patches cannot move (or sense), unless ``leave_unreached`` leaves such modes to their own damping:
    a strip with patches on its faces has them, and they cost the same wherever the patches are.
    """
    checked("problem", problem, Instance(PlacementProblem))
    if not (method in METHODS if isinstance(method, str) else is_search(method)):
        raise unknown_name("method", method, METHODS, ", or a search")
    seed = checked("seed", seed, Count(0, 2**63 - 1))
    if not (progress is None or callable(progress)):
        raise Refused("progress", progress, "None or a function of the share done and the least cost")
    leave_unreached = checked("leave_unreached", leave_unreached, Flag())
    chosen = METHODS[method] if isinstance(method, str) else method
    begin = problem.bounds.uniform() if start is None else problem.bounds.checked(start)
    clock = time.perf_counter()
    recorder = Recorder(problem, progress)
    start_cost = float(recorder.costs(begin[None])[0])
    recorder.note(0.0)
    chosen.run(recorder, begin, np.random.default_rng(seed))
    if not leave_unreached:
        check_reach(problem, recorder.positions)
    return Placement(
        side=problem.side,
        method=method if isinstance(method, str) else type(method).__name__,
        seed=seed,
        positions=tuple(recorder.positions.tolist()),
        cost=recorder.cost,
        start=tuple(begin.tolist()),
        start_cost=start_cost,
        history=tuple(recorder.history),
        evaluations=recorder.evaluations,
        seconds=time.perf_counter() - clock,
    )
