"""The LQG of clipped-lqg, whose filter also estimates a sustained load."""

from baselines import Controller, PersistentLoad, clipped_lqg
from baselines.laws.reference_lqg import RATE_WEIGHT
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """The load is part of the state."""
    return clipped_lqg(design.full_plant, PersistentLoad(), rate_weight=RATE_WEIGHT)
