"""LQG designed on the plant that really moves, which no rival can know. If plants are drawn: on the one that they vary about."""

from baselines import Controller, lqg
from beamenv.knowledge import Truth

KIND = "fixed"
TIER = 3


def build(truth: Truth) -> Controller:
    """Filter and regulator from two discrete Riccati equations of the true plant."""
    return lqg(truth.plant)
