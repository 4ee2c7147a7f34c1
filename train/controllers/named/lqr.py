"""LQR on the full state (no sensor offers it)."""

from baselines import Controller, lqr
from beamenv.knowledge import Truth

KIND = "fixed"
TIER = 3


def check(truth: Truth) -> None:
    """It asks for the full state."""
    truth.check_state_told()


def build(truth: Truth) -> Controller:
    """The regulator alone."""
    return lqr(truth.design.plant)
