"""A controller by what a person types: its name, that of an agent that ships, or the folder of a trained one or of its runs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from baselines import Controller
from beamenv.configuration import Refused, Text, checked
from beamenv.task import Task
from train.controllers.named import discover
from train.controllers.near import near
from train.controllers.runs import runs_in
from train.controllers.shipped import find_shipped, shipped
from train.controllers.sources import Trained


def chosen(name: str, task: Task, scenario: str, seed: int | None = None) -> Controller:
    """The controller for a task; of agents that ship, the one trained on the scenario, or else the generalist.

    Raises ``ValueError`` for an unknown one, for one trained on other plants than the task's design, for the seed of what does
    not ship with several, and for a folder of several runs, which ``chosen_runs`` takes.
    """
    if not _is_folder(name):
        return _by_name(name, task, scenario, seed)
    if seed is not None:
        raise Refused("trained_seed", seed, f"left out, for {name!r} is no agent that ships")
    return Trained(Path(name)).build(task)


def chosen_runs(name: str, task: Task, scenario: str, seed: int | None = None) -> Mapping[str, Controller]:
    """The same, of a folder with several runs each by its number; {"": controller} of what is one."""
    if seed is None and _is_folder(name):
        return {run: Trained(place).build(task) for run, place in runs_in(Path(name)).items()}
    return {"": chosen(name, task, scenario, seed)}


def _is_folder(name: str) -> bool:
    return checked("controller", name, Text()) not in discover() and Path(name).is_dir()


def _by_name(name: str, task: Task, scenario: str, seed: int | None) -> Controller:
    own = set() if name in discover() else {each.scenario for each in shipped() if each.agent == name}
    if own:
        home = "generalist" if scenario not in list(own) and "generalist" in own else scenario
        return Trained(find_shipped(name, home, seed).folder).build(task)
    if seed is not None:
        raise Refused("trained_seed", seed, f"left out, for {name!r} is no agent that ships")
    laws = discover()
    if name not in laws:
        agents = sorted({each.agent for each in shipped()})
        known = f"one of {', '.join(laws)}, of the agents that ship, {', '.join(agents)}, or the folder of a trained agent"
        raise Refused("controller", name, known + near(name, [*laws, *agents]))
    return laws[name].build_for(task)
