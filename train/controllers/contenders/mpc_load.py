"""Model-predictive control whose filter also estimates a load that lasts."""

from baselines import Controller, PersistentLoad, mpc
from beamenv.task import Task

KIND = "predictive"


def build(task: Task) -> Controller:
    """The load is part of the state, of filter and plan alike."""
    return mpc(task.design_plant, persistent_load=PersistentLoad())
