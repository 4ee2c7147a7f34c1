"""A controller by what a person types: its id, an agent's, or the folder of a trained agent or of its runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from baselines import Controller
from beamenv.configuration import Count, Refused, Text, checked
from beamenv.scenarios.named import FORMER as FORMER_SCENARIOS
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.task import Task
from train.controllers.known import FORMER, known_controllers
from train.controllers.named import named
from train.controllers.near import near
from train.controllers.runs import runs_in
from train.controllers.shipped import GENERALIST, SPECIALIST, Agent, recipes, shipped_agents
from train.controllers.sources import Trained


def controller(name: str, env: Any, run: int | None = None) -> Controller:
    """A controller for an environment, single or batched, by its id, that of an agent that ships, or a trained one's folder.

    ``beamenv list controllers`` and ``beamenv list agents`` say which there are; ``run`` is the seed of an agent's training, its
    first if None. What is built knows of the environment what its tier is told. ``ValueError`` for an unknown id, and for what
    cannot be had of what moves there.
    """
    task = getattr(getattr(env, "unwrapped", None), "task", None)
    if not isinstance(task, Task):
        raise Refused("env", env, "an environment of this package")
    return chosen(name, task, _name_of(task), run)


def chosen(name: str, task: Task, scenario: str, seed: int | None = None) -> Controller:
    """The controller for a task, called by its id; of an agent that ships the run of that training seed, or else its first.

    Raises ``ValueError`` for an unknown one, for one trained on other plants than the task's design, for a specialist that was not
    trained on the scenario, for the seed of what is no agent that ships, and for a folder of several runs, which is for
    ``chosen_runs``.
    """
    found = _found(name, scenario, seed)
    if found.runs is None:
        return named(found.id).build_for(task)
    return _trained(found, Path(name) if _is_folder(name) else next(iter(found.runs.values())), task)


def chosen_runs(name: str, task: Task, scenario: str, seed: int | None = None) -> Mapping[str, Controller]:
    """The same with all runs of an agent or a folder, each by its number; {"": controller} of what is one."""
    found = _found(name, scenario, seed)
    if found.runs is None or len(found.runs) == 1:
        return {"": chosen(name, task, scenario, seed)}
    return {run: _trained(found, place, task) for run, place in found.runs.items()}


def id_of(name: str, scenario: str, seed: int | None = None) -> str:
    """What tables and files call whom a name leads to in a scenario; ``ValueError`` as ``chosen`` before anything is built."""
    return _found(name, scenario, seed).id


def folder_id(folder: Path) -> str:
    """What tables and files call the agent in a folder: a run, whose folder has a number alone, is called after both."""
    place = folder.resolve()
    return f"{place.parent.name}-{place.name}" if place.name.isdecimal() else place.name


@dataclass(frozen=True, slots=True)
class _Found:
    """Whom a name leads to."""

    id: str
    runs: Mapping[str, Path] | None = None
    """Folders of trained agents by their runs; None of a controller that is built."""


def _found(name: str, scenario: str, seed: int | None) -> _Found:
    folder, scenario = _is_folder(name), FORMER_SCENARIOS.get(scenario, scenario)
    agent = None if folder else _agent(name, scenario)
    if agent is not None:
        return _Found(agent.id, _runs_of(agent, scenario, seed))
    if seed is not None:
        raise Refused("trained_seed", seed, f"left out, for {name!r} is no agent that ships")
    return _Found(folder_id(Path(name)), runs_in(Path(name))) if folder else _Found(_controller(name))


def _controller(name: str) -> str:
    """The id of a controller that is built; ``ValueError`` lists them, and the agents."""
    laws, agents = known_controllers(), shipped_agents()
    if FORMER.get(name, name) in laws:
        return FORMER.get(name, name)
    known = f"one of {', '.join(laws)}, of the agents that ship, {', '.join(agents)}, or the folder of a trained agent"
    raise Refused("controller", name, known + near(name, [*laws, *agents, *recipes(agents)], recipes(agents)))


def _agent(name: str, scenario: str) -> Agent | None:
    """The agent of that id; of a recipe's name the specialist of the scenario, or else the generalist."""
    agents = shipped_agents()
    if name in agents or name in known_controllers():
        return agents.get(name)
    own = [agents[each] for each in (f"{name}-{SPECIALIST}", f"{name}-{GENERALIST}") if each in agents]
    return next((each for each in own if each.runs(scenario)), own[0] if own else None)


def _runs_of(agent: Agent, scenario: str, seed: int | None) -> Mapping[str, Path]:
    runs = agent.runs(scenario)
    if not runs:
        raise Refused("scenario", scenario, f"one that the agent {agent.id!r} was trained on: {', '.join(agent.only_in)}")
    if seed is None:
        return {str(own): run.folder for own, run in runs.items()}
    if checked("trained_seed", seed, Count(0)) not in runs:
        raise Refused("trained_seed", seed, f"that of a run of {agent.id!r}: {', '.join(map(str, runs))}")
    return {str(seed): runs[seed].folder}


def _is_folder(name: str) -> bool:
    known = checked("controller", name, Text()) in {**known_controllers(), **shipped_agents(), **FORMER}
    return not known and Path(name).is_dir()


def _trained(found: _Found, folder: Path, task: Task) -> Controller:
    return replace(Trained(folder).build(task), name=found.id)


def _name_of(task: Task) -> str:
    """Of a task's scenario, if it has one."""
    known = task.scenario if task.told_scenario is None else task.told_scenario
    return next((name for name, each in SCENARIOS.items() if each == known), "one of the caller's own")
