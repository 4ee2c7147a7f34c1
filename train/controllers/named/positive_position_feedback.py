"""Positive position feedback on the sensors' charge, with the gains of least stationary cost."""

from baselines import Controller, positive_position_feedback
from baselines.laws.velocity_feedback import pairing
from beamenv import Design

KIND = "fixed"
TIER = 0


def check(design: Design) -> None:
    """It asks for pairs of actuators and sensors."""
    pairing(design.plant, "positive position feedback")


def build(design: Design) -> Controller:
    """A filter for each of three modes on each pair of patches."""
    return positive_position_feedback(design.full_plant)
