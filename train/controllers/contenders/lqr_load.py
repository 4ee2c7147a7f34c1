"""LQR on the true state and an estimate of the load that lasts."""

from baselines import Controller, PersistentLoad, lqr
from beamenv.task import Task

KIND = "bound"


def build(task: Task) -> Controller:
    """The regulator, with an observer for the load."""
    return lqr(task.design_plant, persistent_load=PersistentLoad())
