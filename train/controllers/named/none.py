"""No control: what every other controller is measured against."""

from baselines import Controller, no_control
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """Zero volts always."""
    return no_control(design.plant)
