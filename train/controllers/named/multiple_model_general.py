"""One multiple-model controller for all scenarios, not told which it is in; its cases are those of all but the unseen ones."""

from baselines import Controller
from beamenv import Prior
from train.controllers.general_bank import general_law

KIND = "adaptive"
TIER = 1


def build(prior: Prior) -> Controller:
    """Of the prior it takes the blade alone."""
    return general_law(prior.blade)
