"""LQG whose filter also estimates a load that lasts."""

from baselines import Controller, PersistentLoad, lqg
from beamenv import Design

KIND = "fixed"


def build(design: Design) -> Controller:
    """The load is part of the state."""
    return lqg(design.plant, persistent_load=PersistentLoad())
