"""Patches placed, side by side of the blade, with what each placement is compared with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

UNITS = {"actuators": ("tr(P)", "s"), "sensors": ("tr(S)", "J")}
LAWS = {"actuators": "regulator", "sensors": "filter"}


@dataclass(frozen=True, slots=True, eq=False)
class PlacedSide:
    """One side's patches placed, beside the uniform layout."""

    problem: Any
    """The ``PlacementProblem``."""
    placement: Any
    """The ``Placement``."""
    uniform_cost: float
    left_alone: Array
    """Damping ratio of each mode without control, with the patches where they were put."""
    uniform: Array
    """… under the regulator (or of the filter's error), patches equally spaced."""
    placed: Array
    """… with the patches where they were put."""
    families: tuple[str, ...]
    """What most of each mode's motion is: lag, flap, extension or twist."""

    @property
    def note(self) -> str:
        """On those of them that are next to the clamp; empty where none is."""
        from beamenv.blade.clamp import clamp_note
        from beamenv.blade.layouts import with_positions

        side = self.placement.side
        return clamp_note(with_positions(self.problem.config, {side: self.placement.positions}), (side,))

    def to_dict(self) -> dict[str, Any]:
        """What ``--json`` prints."""
        placement = asdict(self.placement)
        unit = UNITS[self.placement.side]
        return {
            **placement,
            "trace": unit[0],
            "unit": unit[1],
            "uniform": {"positions": self.problem.bounds.uniform().tolist(), "cost": self.uniform_cost},
            "note": self.note,
            "gap_to_uniform": 1.0 - self.placement.cost / self.uniform_cost,
            "damping_ratios": {
                "without_control": self.left_alone.tolist(),
                "uniform": self.uniform.tolist(),
                "placed": self.placed.tolist(),
                "families": list(self.families),
            },
        }


def place_sides(
    config: Any,
    counts: dict[Any, int],
    method: str,
    seed: int,
    progress: Callable[[str, float, float], None] | None = None,
    leave_unreached: bool = False,
) -> list[PlacedSide]:
    """Place the sides that ``counts`` names, actuators first, then the sensors of the blade with its actuators placed.

    Until a side is placed, its patches are where the blade has them, or equally spaced where they are to be of another number.
    """
    from baselines.placement import PlacementProblem, place
    from baselines.placement.cost.problem import read_of_patches
    from beamenv.blade.config import BladeConfig
    from beamenv.blade.layouts import SIDES, positions_of, with_positions
    from beamenv.configuration import Count, Instance, checked, checked_table

    checked("config", config, Instance(BladeConfig))
    for name, count in checked_table("counts", counts, SIDES).items():
        checked(f"counts.{name}", count, Count())
    if "sensors" in counts:
        read_of_patches(config)  # before actuators are searched for
    other = {side: count for side, count in counts.items() if count != len(positions_of(config, side))}
    config, sides = with_positions(config, other), []
    for side in SIDES:
        if side not in counts:
            continue
        problem = PlacementProblem.of(config, side)
        report = None if progress is None else lambda done, cost, side=side: progress(side, done, cost)
        found = place(problem, method, seed, progress=report, leave_unreached=leave_unreached)
        config = with_positions(config, {side: found.positions})
        sides.append(placed_side(problem, found))
    return sides


def placed_side(problem: Any, placement: Any) -> PlacedSide:
    """A placement with what it is compared with."""
    from baselines.placement.cost.controllability import families
    from baselines.placement.cost.damping import design_poles, open_loop_poles
    from beamenv.plant.poles import damping_ratios

    uniform = problem.bounds.uniform()
    return PlacedSide(
        problem=problem,
        placement=placement,
        uniform_cost=float(problem.cost(uniform[None])[0]),
        left_alone=damping_ratios(open_loop_poles(problem, placement.positions)),
        uniform=damping_ratios(design_poles(problem, uniform)),
        placed=damping_ratios(design_poles(problem, placement.positions)),
        families=families(problem.configuration(placement.positions)),
    )
