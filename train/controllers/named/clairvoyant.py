"""LQG that is told each episode's plant, delay and faults: it shows how much there is to gain by knowing them."""

from baselines import Controller, clairvoyant_lqg
from beamenv.knowledge import Truth
from beamenv.scenarios.scenario import Scenario

KIND = "scheduled"
TIER = 3


def build(truth: Truth) -> Controller:
    """With a filter that estimates the loads that the scenario lets foresee, and gains that vary with time."""
    return clairvoyant_lqg(truth)


def suits(scenario: Scenario) -> bool:
    """Not where plants wander within the episode: it is told one plant, or a spin-up that is the same in every episode."""
    return not scenario.plants.walks
