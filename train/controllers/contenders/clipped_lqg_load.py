"""LQG that knows of clipping and estimates a load that lasts."""

from baselines import Controller, PersistentLoad, clipped_lqg
from beamenv.task import Task

KIND = "fixed"


def build(task: Task) -> Controller:
    """The load is part of the state."""
    return clipped_lqg(task.design_plant, persistent_load=PersistentLoad())
