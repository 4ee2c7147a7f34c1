"""The reference LQG with a neural network that learns, within each episode, what the design does not contain."""

from baselines import Controller, adaptive_neural
from beamenv import Design

KIND = "adaptive"
TIER = 0


def build(design: Design) -> Controller:
    """Told what LQG is; the network starts every episode knowing nothing."""
    return adaptive_neural(design.full_plant)
