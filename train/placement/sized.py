"""Patches sized and placed together, beside the layouts that the blade's own patches have."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any


@dataclass(frozen=True, slots=True, eq=False)
class SizedFront:
    """A front, with what it is compared with."""

    problem: Any
    """The ``SizingProblem``."""
    front: Any
    """The ``Front``."""
    layouts: tuple[Any, ...]
    """``Layout``s of the blade's own patches."""
    on_plants: tuple[float, ...]
    """J of each point of the front on the plant that is built of it."""
    left_out: int
    """How many points are left out, as no blade can be computed with their patches: thick sheets whose edges nearly meet."""

    @property
    def chosen(self) -> int:
        """Which point: the cheapest that is no heavier than the budget or, where mass is not limited, than the blade's own patches;
        the lightest where all are.
        """
        limit = self.problem.budget.mass
        if limit is None:
            limit = max((each.mass for each in self.layouts), default=float("inf"))
        return max((k for k, each in enumerate(self.front.points) if each.mass <= limit * (1.0 + 1e-9)), default=0)

    def to_dict(self) -> dict[str, Any]:
        """What ``--json`` prints."""
        front, problem = asdict(self.front), self.problem
        points = [{**each, "cost_on_plant": cost} for each, cost in zip(front["points"], self.on_plants, strict=True)]
        budget = {**asdict(problem.budget), "frequency": problem.frequency}
        layouts = [asdict(each) for each in self.layouts]
        return {
            **front,
            "points": points,
            "chosen": self.chosen,
            "layouts": layouts,
            "budget": budget,
            "drive_weight": problem.drive_weight,
            "left_out": self.left_out,
        }


def size_patches(
    config: Any,
    sizes: Any,
    budget: Any,
    seed: int = 0,
    progress: Callable[[float, float], None] | None = None,
    search: Any = None,
    placed: bool = True,
) -> SizedFront:
    """The front of a blade; interrupted, what was found until then, unless that is nothing. ``placed`` adds the blade's own patches
    where they are best, which takes some seconds the first time.
    """
    from baselines.placement import SizingProblem, size
    from baselines.placement.sizing.front import Archive
    from baselines.placement.sizing.own_layouts import layouts_of

    problem = SizingProblem.of(config, sizes, budget)
    archive = Archive(problem, progress)
    try:
        front = size(problem, seed, search, archive=archive)
    except KeyboardInterrupt:
        front = archive.front(seed, complete=False)
        if not front.points:
            raise
    every = [(each, plant_cost(problem, each)) for each in front.points]
    built = [(each, cost) for each, cost in every if cost is not None]
    if not built:
        raise ValueError(f"none of {len(every)} designs makes a blade that can be computed: take thinner sheets.")
    told = replace(front, points=tuple(each for each, _ in built))
    layouts = layouts_of(problem, config, placed and front.complete)
    return SizedFront(problem, told, layouts, tuple(cost for _, cost in built), len(every) - len(built))


def plant_cost(problem: Any, point: Any) -> float | None:
    """J on the plant that is built of a point; None where none can be computed."""
    from baselines.placement.sizing.blades import cost_on_plant

    try:
        return cost_on_plant(problem, point)
    except ValueError:
        return None
