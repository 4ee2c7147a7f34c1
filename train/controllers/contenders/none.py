"""No control: what every other controller is measured against."""

from baselines import Controller, no_control
from beamenv.task import Task

KIND = "fixed"


def build(task: Task) -> Controller:
    """Zero volts always."""
    return no_control(task.design_plant)
