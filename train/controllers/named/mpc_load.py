"""Model-predictive control whose filter also estimates a sustained load."""

from baselines import Controller, PersistentLoad, mpc
from baselines.laws.reference_lqg import RATE_WEIGHT
from beamenv import Design

KIND = "predictive"
TIER = 0


def build(design: Design) -> Controller:
    """The load is part of the state, of filter and plan alike."""
    return mpc(design.full_plant, PersistentLoad(), rate_weight=RATE_WEIGHT)
