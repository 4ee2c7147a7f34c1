"""H-infinity output feedback: the noise of a given energy that is worst."""

from baselines import Controller
from baselines.laws.h_infinity import h_infinity_law, least_attenuation
from beamenv import Design

KIND = "fixed"


def build(design: Design) -> Controller:
    """On the full plant, for half as much again as the least attenuation that is possible on the design's, which is soon found."""
    return h_infinity_law(design.full_plant, 1.5 * least_attenuation(design.plant))
