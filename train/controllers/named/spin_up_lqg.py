"""LQG that knows the course of the rotor's spin-up and has gains for each instant; without a spin-up, the nominal plant's."""

from baselines import Controller, spin_up_lqg
from beamenv import Prior

KIND = "scheduled"
TIER = 1


def build(prior: Prior) -> Controller:
    """With a filter that estimates the loads that the scenario lets foresee."""
    return spin_up_lqg(prior)
