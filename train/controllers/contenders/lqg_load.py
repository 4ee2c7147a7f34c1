"""LQG whose filter also estimates a load that lasts."""

from baselines import Controller, PersistentLoad, lqg
from beamenv.task import Task

KIND = "fixed"


def build(task: Task) -> Controller:
    """The load is part of the state."""
    return lqg(task.design_plant, persistent_load=PersistentLoad())
