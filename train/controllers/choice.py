"""A controller by what a person types: its name, that of an agent that ships, or a trained agent's folder."""

from __future__ import annotations

from pathlib import Path

from baselines import Controller
from beamenv.configuration import Refused
from beamenv.task import Task
from train.controllers.named import discover, named
from train.controllers.policy_files import load_policy
from train.controllers.shipped import load_shipped, shipped


def chosen(name: str, task: Task, scenario: str, seed: int | None = None) -> Controller:
    """The controller for a task; of agents that ship, the one trained on the scenario, or else the generalist.

    Raises ``ValueError`` for an unknown one, for one trained on other plants than the task's design, and for the seed of what does
    not ship with several.
    """
    folder = name not in discover() and Path(name).is_dir()
    own = set() if folder or name in discover() else {each.scenario for each in shipped() if each.agent == name}
    if own:
        return load_shipped(name, scenario if scenario in own else "generalist", seed, task.design_plant)
    if seed is not None:
        raise Refused("trained_seed", seed, f"left out, for {name!r} is no agent that ships")
    return load_policy(Path(name), task.design_plant) if folder else named(name).build_for(task)
