"""The reference LQG with a model of the loads at one to four per revolution."""

from baselines import Controller, RotorHarmonics, reference_lqg
from beamenv import Design

KIND = "fixed"


def build(design: Design) -> Controller:
    """Tuned to the speed of the design."""
    return reference_lqg(design.full_plant, load=RotorHarmonics(design.config.speed), name="LQG with rotor harmonics")
