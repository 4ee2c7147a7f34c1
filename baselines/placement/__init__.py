"""Where the patches belong: positions that make tr(P) of the regulator, or tr(S) of the filter, least (thesis chapter 6).

Both sides' together by the closed loop's cost; and with their sizes and number, by what they weigh.
"""

from baselines.placement.cost.controllability import check_reach, reach
from baselines.placement.cost.joint_problem import JointProblem
from baselines.placement.cost.problem import PlacementProblem
from baselines.placement.optimal import optimal_layout, optimal_positions
from baselines.placement.search.joint import JointPlacement, place_jointly
from baselines.placement.search.placement import Placement
from baselines.placement.search.search import METHODS, place
from baselines.placement.sizing.blades import sized_blade
from baselines.placement.sizing.front import Front, FrontPoint
from baselines.placement.sizing.limits import Budget, Sizes
from baselines.placement.sizing.problem import SizingProblem
from baselines.placement.sizing.search import SizingSearch, size

__all__ = [
    "METHODS",
    "Budget",
    "Front",
    "FrontPoint",
    "JointPlacement",
    "JointProblem",
    "Placement",
    "PlacementProblem",
    "Sizes",
    "SizingProblem",
    "SizingSearch",
    "check_reach",
    "optimal_layout",
    "optimal_positions",
    "place",
    "place_jointly",
    "reach",
    "size",
    "sized_blade",
]
