"""LQG of the plant that really moves, which no rival can know; where plants are drawn, of the one that they depart from."""

from baselines import Controller, lqg
from beamenv.knowledge import Truth

KIND = "fixed"
TIER = 3


def build(truth: Truth) -> Controller:
    """Filter and regulator from two discrete Riccati equations of the true plant."""
    return lqg(truth.plant)
