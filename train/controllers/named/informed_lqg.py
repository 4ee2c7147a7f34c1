"""LQG detuned for the scenario by an automatic rule, which is tried on episodes of the training plants."""

from baselines import Controller, informed_lqg
from beamenv import Prior

KIND = "fixed"
TIER = 1


def build(prior: Prior) -> Controller:
    """What the rule chose is shipped for the default blade, and searched for otherwise: a minute or two, once."""
    return informed_lqg(prior)
