"""Model-predictive control within the drive limits, with the filter of the sampled LQG."""

from baselines import Controller, mpc
from beamenv.task import Task

KIND = "predictive"


def build(task: Task) -> Controller:
    """A quadratic program at every instant in which a limit is in sight."""
    return mpc(task.design_plant)
