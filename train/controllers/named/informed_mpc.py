"""Model-predictive control within the drive limits; a rule chooses delay, weights and loads for the scenario."""

from baselines import Controller, informed_mpc
from beamenv import Prior

KIND = "predictive"
TIER = 1


def build(prior: Prior) -> Controller:
    """What the rule of `informed-lqg` chose."""
    return informed_mpc(prior)
