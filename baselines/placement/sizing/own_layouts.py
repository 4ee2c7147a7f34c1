"""The blade's own patches by the measure of a front: as they are given, where the thesis has them, and where they are best."""

from __future__ import annotations

from dataclasses import dataclass, replace

from baselines.placement.optimal import optimal_layout
from baselines.placement.sizing.problem import SizingProblem
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.blade.layouts import SIDES, THESIS_TABLES, positions_of, thesis_positions
from beamenv.patches.group import Positions

THESIS = "thesis, Tables 6.3 and 6.4"


@dataclass(frozen=True, slots=True)
class Layout:
    """The blade's own patches somewhere."""

    name: str
    mass: float
    """kg."""
    cost: float
    """J."""


def layouts_of(problem: SizingProblem, config: BladeConfig, placed: bool) -> tuple[Layout, ...]:
    """Those of a blade, whatever its budget; ``placed`` by ``optimal_layout``, which takes seconds once."""
    counts = [max(each) for each in zip(problem.limits.counts, map(len, configured(config)), strict=True)]
    problem = replace(problem, limits=replace(problem.limits, counts=(counts[0], counts[1])))
    places = {"as configured": configured(config)}
    thesis = thesis_places(config)
    if thesis is not None:
        places[THESIS] = thesis
    if placed:
        best = optimal_layout(config)
        places["placed"] = [best[side] for side in SIDES]
    found = []
    for name, positions in places.items():
        designs = problem.with_own_sizes(positions)
        if designs is not None:
            found.append(Layout(name, float(problem.mass(designs)[0]), float(problem.cost(designs)[0])))
    return tuple(found)


def configured(config: BladeConfig) -> list[Positions]:
    """Positions of both sides, m."""
    return [positions_of(config, side) for side in SIDES]


def thesis_places(config: BladeConfig) -> list[Positions] | None:
    """Positions of the thesis' tables for a blade of its size with as many patches; None for any other."""
    if config.beam.section is not None or config.beam.length != BeamConfig().length:
        return None
    try:
        return [thesis_positions(config, side, name, len(positions_of(config, side))) for name, side in THESIS_TABLES.items()]
    except ValueError:
        return None
