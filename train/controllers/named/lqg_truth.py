"""LQG of the plant that really moves: what no rival can know. Where plants are drawn, of the one that they depart from."""

from dataclasses import replace

from baselines import Controller, lqg
from beamenv.knowledge import Truth

KIND = "fixed"
TIER = 3


def build(truth: Truth) -> Controller:
    """Filter and regulator from two discrete Riccati equations of the true plant."""
    return replace(lqg(truth.plant), name="LQG (told the truth)")
