"""LQR on the true state."""

from baselines import Controller, lqr
from beamenv.task import Task

KIND = "bound"


def build(task: Task) -> Controller:
    """The regulator alone."""
    return lqr(task.design_plant)
