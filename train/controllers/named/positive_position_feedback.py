"""Positive position feedback on the sensors' charge, its gains those of least stationary cost."""

from baselines import Controller, positive_position_feedback
from beamenv import Design

KIND = "fixed"
TIER = 0


def build(design: Design) -> Controller:
    """A filter for each of three modes on each pair of patches."""
    return positive_position_feedback(design.full_plant)
