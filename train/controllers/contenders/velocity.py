"""Collocated velocity feedback with the gains of least stationary cost."""

from baselines import Controller, velocity_feedback
from beamenv.task import Task

KIND = "fixed"


def build(task: Task) -> Controller:
    """One gain for each pair of actuator and sensor."""
    return velocity_feedback(task.design_plant)
