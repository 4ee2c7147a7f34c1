"""The reference LQG, designed on all that is known of the blade: every other controller is compared with it, episode by episode."""

from baselines import Controller, reference_lqg
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """Filter and regulator of the design blade's full plant, with a price on quick changes, reduced in the closed loop."""
    return reference_lqg(design.full_plant)
