"""One multiple-model law for every scenario, not told in which it is: over what may be the case in any of the seen ones."""

from baselines import Controller
from beamenv import Prior
from train.controllers.general_bank import general_law

KIND = "adaptive"
TIER = 1


def build(prior: Prior) -> Controller:
    """Of the prior it takes the blade alone."""
    return general_law(prior.blade)
