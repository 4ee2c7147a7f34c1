"""Collocated velocity feedback with the gains of least stationary cost."""

from baselines import Controller, velocity_feedback
from baselines.laws.velocity_feedback import pairing
from beamenv import Design

KIND = "fixed"
TIER = 0


def check(design: Design) -> None:
    """It asks for pairs of actuators and sensors."""
    pairing(design.plant, "velocity feedback")


def build(design: Design) -> Controller:
    """One gain for each pair of actuator and sensor."""
    return velocity_feedback(design.plant, tuned_on=design.full_plant)
