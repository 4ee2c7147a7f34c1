"""LQG that knows the course of the rotor's spin-up, with the gains of each instant; without one, those of the nominal plant."""

from baselines import Controller, spin_up_lqg
from beamenv import Prior

KIND = "scheduled"
TIER = 1


def build(prior: Prior) -> Controller:
    """With a filter that estimates the loads that the scenario lets foresee."""
    return spin_up_lqg(prior)
