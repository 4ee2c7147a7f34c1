"""LQR on the true state."""

from baselines import Controller, lqr
from beamenv.knowledge import Truth

KIND = "fixed"
TIER = 3


def build(truth: Truth) -> Controller:
    """The regulator alone."""
    return lqr(truth.design.plant)
