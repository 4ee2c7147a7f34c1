"""LQG of the sampled design plant: optimal for its eleven modes, and for them alone."""

from baselines import Controller, lqg
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """Filter and regulator from two discrete Riccati equations."""
    return lqg(design.plant)
