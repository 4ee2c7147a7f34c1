"""Model-predictive control within the drive limits, with the delay, weights and loads that the scenario's rule chooses."""

from baselines import Controller, informed_mpc
from beamenv import Prior

KIND = "predictive"
TIER = 1


def build(prior: Prior) -> Controller:
    """What the rule of `informed-lqg` chose."""
    return informed_mpc(prior)
