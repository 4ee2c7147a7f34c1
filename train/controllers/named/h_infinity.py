"""H-infinity output feedback: the least cost under the worst noise of a given energy."""

from baselines import Controller, h_infinity
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """On all that is known of the blade, for half as much again as the least attenuation that is possible there."""
    return h_infinity(design.full_plant)
