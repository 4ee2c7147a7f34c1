"""LQG as in the thesis: designed in continuous time, then sampled."""

from baselines import Controller, lqg
from beamenv.task import Task

KIND = "fixed"


def build(task: Task) -> Controller:
    """Filter and regulator from two continuous Riccati equations."""
    return lqg(task.design_plant, design="continuous")
