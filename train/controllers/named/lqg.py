"""LQG of the sampled plant: what every other controller is compared with in pairs."""

from baselines import Controller, lqg
from beamenv import Design

KIND = "fixed"


def build(design: Design) -> Controller:
    """Filter and regulator from two discrete Riccati equations."""
    return lqg(design.plant)
