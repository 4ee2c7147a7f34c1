"""LQG as in the thesis: designed in continuous time, then sampled."""

from baselines import Controller, lqg
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """Filter and regulator from two continuous Riccati equations, as they come out: sampled, they are unstable on some blades."""
    return lqg(design.plant, design="continuous", verify=False)
