"""A controller by what a person types: its id, an agent's, or the folder of a trained agent or of its runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from baselines import Controller
from beamenv.configuration import Refused
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.task import Task
from train.controllers.ids import found
from train.controllers.named import named
from train.controllers.sources import Trained


def controller(name: str, env: Any, trained_seed: int | None = None) -> Controller:
    """A controller for an environment, single or batched, by its id, that of an agent that ships, or a trained one's folder.

    ``beamenv list controllers`` and ``beamenv list agents`` say which there are; ``trained_seed`` is that of an agent's
    training run, its first if None. What is built knows of the environment what its tier is told. ``ValueError`` for an unknown id,
    and for what cannot be had of what moves there.
    """
    task = getattr(getattr(env, "unwrapped", None), "task", None)
    if not isinstance(task, Task):
        raise Refused("env", env, "an environment of this package")
    return chosen(name, task, _name_of(task), trained_seed)


def chosen(name: str, task: Task, scenario: str, seed: int | None = None) -> Controller:
    """The controller for a task, called by its id; of an agent that ships the run of that training seed, or else its first.

    Raises ``ValueError`` as ``found``, for one trained on other plants than the task's design, and for a folder of several runs,
    which is for ``chosen_runs``.
    """
    lead = found(name, scenario, seed)
    if lead.runs is None:
        return named(lead.id).build_for(task)
    return _trained(lead.folder or next(iter(lead.runs.values())), task, lead.id)


def chosen_runs(name: str, task: Task, scenario: str, seed: int | None = None) -> Mapping[str, Controller]:
    """The same with all runs of an agent or a folder, each by its number; {"": controller} of what is one."""
    lead = found(name, scenario, seed)
    if lead.runs is None or len(lead.runs) == 1:
        return {"": chosen(name, task, scenario, seed)}
    return {run: _trained(place, task, lead.id) for run, place in lead.runs.items()}


def _trained(folder: Path, task: Task, name: str) -> Controller:
    return replace(Trained(folder).build(task), name=name)


def _name_of(task: Task) -> str:
    """Of a task's scenario, if it has one."""
    known = task.scenario if task.told_scenario is None else task.told_scenario
    return next((name for name, each in SCENARIOS.items() if each == known), "one of the caller's own")
