"""LQG designed on all that is known of the blade; its filter takes into account that readings clip at full scale."""

from baselines import Controller, clipped_lqg
from baselines.laws.reference_lqg import RATE_WEIGHT
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """LQG itself while no reading clips."""
    return clipped_lqg(design.full_plant, rate_weight=RATE_WEIGHT)
