"""Where the patches belong: positions that make tr(P) of the regulator, or tr(S) of the filter, least (thesis chapter 6)."""

from baselines.placement.cost.controllability import check_reach, reach
from baselines.placement.cost.problem import PlacementProblem
from baselines.placement.optimal import optimal_layout, optimal_positions
from baselines.placement.search.placement import Placement
from baselines.placement.search.search import METHODS, place

__all__ = [
    "METHODS",
    "Placement",
    "PlacementProblem",
    "check_reach",
    "optimal_layout",
    "optimal_positions",
    "place",
    "reach",
]
