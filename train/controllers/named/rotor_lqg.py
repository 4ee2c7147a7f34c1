"""LQG with a model of the loads at one to four per revolution."""

from baselines import Controller, RotorHarmonics, rotor_lqg
from beamenv import Design

KIND = "fixed"


def build(design: Design) -> Controller:
    """Tuned to the speed of the design."""
    return rotor_lqg(design.plant, RotorHarmonics(design.config.speed))
