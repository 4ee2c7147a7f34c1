"""LQG with a model of the loads at one to four per revolution."""

from baselines import Controller, RotorHarmonics, rotor_lqg
from beamenv.task import Task

KIND = "fixed"


def build(task: Task) -> Controller:
    """Tuned to the speed of the design."""
    return rotor_lqg(task.design_plant, RotorHarmonics(task.design_config.speed))
