"""LQG that follows the measured speed of the rotor."""

import numpy as np

from baselines import Controller, scheduled_lqg_for
from beamenv import Design

KIND = "scheduled"

RANGE = np.linspace(0.5, 1.5, 11)
"""Speeds over that of the design: half of it either way, in steps of 20 rad/s on the default blade."""


def build(design: Design) -> Controller:
    """An LQG for each of eleven speeds, mixed in between."""
    return scheduled_lqg_for(design.config, RANGE * design.config.speed)
