"""The reference LQG with a filter that also estimates a sustained load."""

from baselines import Controller, PersistentLoad, reference_lqg
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """The load is part of the state."""
    return reference_lqg(design.full_plant, load=PersistentLoad())
