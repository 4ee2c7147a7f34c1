"""The reference LQG with a model of the loads at one to four per revolution, and of a sustained load."""

from baselines import Controller, PersistentLoad, RotorHarmonics, reference_lqg
from beamenv import Design

KIND = "fixed"
TIER = 0


def check(design: Design) -> None:
    """It asks for a rotor."""
    design.turning_config("rotor-lqg")


def build(design: Design) -> Controller:
    """Tuned to the speed of the design; the lasting load also takes up what is slow in turbulence."""
    loads = (RotorHarmonics(design.turning_config("rotor-lqg").speed), PersistentLoad())
    return reference_lqg(design.full_plant, load=loads)
