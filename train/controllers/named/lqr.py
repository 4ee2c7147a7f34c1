"""LQR on the true state."""

from baselines import Controller, lqr
from beamenv import Design

KIND = "bound"


def build(design: Design) -> Controller:
    """The regulator alone."""
    return lqr(design.plant)
