"""LQR on the full state (no sensor offers it) and an estimate of a sustained load."""

from baselines import Controller, PersistentLoad, lqr
from beamenv.knowledge import Truth

KIND = "fixed"
TIER = 3


def check(truth: Truth) -> None:
    """It asks for the full state."""
    truth.check_state_told()


def build(truth: Truth) -> Controller:
    """The regulator, with an observer for the load."""
    return lqr(truth.design.plant, persistent_load=PersistentLoad())
