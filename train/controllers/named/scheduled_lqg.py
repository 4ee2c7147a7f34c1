"""LQG that follows the measured speed of the rotor."""

import numpy as np

from baselines import Controller, scheduled_lqg_for
from baselines.laws.reference_lqg import RATE_WEIGHT
from beamenv import Prior

KIND = "scheduled"
TIER = 2

RANGE = np.linspace(0.5, 1.5, 7)
"""Speeds over that of the design: half of it either way. On the default blade, every 33 rad/s, the law costs 0.8 % more than each
speed's own optimum at most."""


def check(prior: Prior) -> None:
    """It asks for a rotor."""
    prior.design.turning_config("scheduled-lqg")


def build(prior: Prior) -> Controller:
    """An LQG of all that is known of the blade for each of seven speeds, mixed in between."""
    config = prior.design.turning_config("scheduled-lqg")
    return scheduled_lqg_for(config, RANGE * config.speed, full=True, rate_weight=RATE_WEIGHT)
