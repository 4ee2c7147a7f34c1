"""A controller by what a person types: a contender's name, that of an agent that ships, or a trained agent's folder."""

from __future__ import annotations

from pathlib import Path

from baselines import Controller
from beamenv.task import Task
from train.controllers.contenders import contender, discover
from train.controllers.policy_files import load_policy
from train.controllers.shipped import load_shipped, shipped


def chosen(name: str, task: Task, scenario: str, seed: int | None = None) -> Controller:
    """The controller of a task; of agents that ship, the one trained on the scenario, or else the generalist.

    Raises ``ValueError`` for an unknown one, or one trained on other plants than the task's design plant.
    """
    if name not in discover():
        if Path(name).is_dir():
            return load_policy(Path(name), task.design_plant)
        if own := {each.scenario for each in shipped() if each.agent == name}:
            return load_shipped(name, scenario if scenario in own else "generalist", seed, task.design_plant)
    return contender(name).build(task)
