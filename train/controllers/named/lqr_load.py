"""LQR on the true state and an estimate of the load that lasts."""

from baselines import Controller, PersistentLoad, lqr
from beamenv import Design

KIND = "bound"


def build(design: Design) -> Controller:
    """The regulator, with an observer for the load."""
    return lqr(design.plant, persistent_load=PersistentLoad())
