"""Model-predictive control within the drive limits, with LQG's filter, designed on all that is known of the blade."""

from baselines import Controller, mpc
from baselines.laws.reference_lqg import RATE_WEIGHT
from beamenv import Design

KIND = "predictive"
TIER = 0


def build(design: Design) -> Controller:
    """A quadratic program at every instant in which a limit is in sight."""
    return mpc(design.full_plant, rate_weight=RATE_WEIGHT)
