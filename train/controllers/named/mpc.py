"""Model-predictive control within the drive limits, with the filter of the sampled LQG."""

from baselines import Controller, mpc
from beamenv import Design

KIND = "predictive"


def build(design: Design) -> Controller:
    """A quadratic program at every instant in which a limit is in sight."""
    return mpc(design.plant)
