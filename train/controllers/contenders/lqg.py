"""LQG of the sampled plant: what every other controller is compared with in pairs."""

from baselines import Controller, lqg
from beamenv.task import Task

KIND = "fixed"


def build(task: Task) -> Controller:
    """Filter and regulator from two discrete Riccati equations."""
    return lqg(task.design_plant)
