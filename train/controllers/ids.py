"""Whom a name leads to, before anything is built: a controller, an agent that ships, the folder of a trained one or of its runs."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from beamenv.configuration import Count, Refused, Text, checked
from beamenv.configuration.near import meant
from beamenv.scenarios.named import FORMER as FORMER_SCENARIOS
from train.controllers.known import FORMER, known_controllers
from train.controllers.runs import runs_in
from train.controllers.shipped import GENERALIST, SPECIALIST, Agent, recipes, shipped_agents


@dataclass(frozen=True, slots=True)
class Found:
    """Whom a name leads to."""

    id: str
    """What tables, figures and files call it."""
    runs: Mapping[str, Path] | None = None
    """Folders of trained agents by their runs; None of a controller that is built."""
    folder: Path | None = None
    """The one that was named, if it was."""


def found(name: str, scenario: str, seed: int | None = None) -> Found:
    """Whom an id, a folder or the name of an agent's recipe leads to in a scenario; ``seed`` leaves that run of what ships alone.

    Raises ``ValueError`` of one sentence, with those whose ids are like it, for an unknown name, for a specialist that was not
    trained on the scenario, and for a run that does not ship.
    """
    folder, scenario = _folder(name), checked("scenario", scenario, Text())
    scenario = FORMER_SCENARIOS.get(scenario, scenario)
    agent = None if folder is not None else _agent(name, scenario)
    if agent is not None:
        return Found(agent.id, _runs_of(agent, scenario, seed))
    if seed is not None:
        raise Refused("trained_seed", seed, f"left out, for {name!r} is no agent that ships")
    return Found(_controller(name)) if folder is None else Found(folder_id(folder), runs_in(folder), folder)


def folder_id(folder: Path) -> str:
    """What tables and files call the agent in a folder: a run, whose folder has a number alone, is called after both."""
    place = folder.resolve()
    return f"{place.parent.name}-{place.name}" if place.name.isdecimal() else place.name


def _folder(name: str) -> Path | None:
    known = checked("controller", name, Text()) in {**known_controllers(), **shipped_agents(), **FORMER}
    return Path(name) if not known and os.path.isdir(name) else None  # which the empty text is not


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
        return {str(each): run.folder for each, run in runs.items()}
    own = checked("trained_seed", seed, Count(0))
    if own not in runs:
        raise Refused("trained_seed", seed, f"that of a run of {agent.id!r}: {', '.join(map(str, runs))}")
    return {str(own): runs[own].folder}


def _controller(name: str) -> str:
    """The id of a controller that is built; ``ValueError`` lists them, and the agents."""
    if FORMER.get(name, name) not in known_controllers():
        raise unknown(name)
    return FORMER.get(name, name)


def is_known(name: str) -> bool:
    """Whether a name is an id, one of former days, or that of the recipe of an agent that ships."""
    agents = shipped_agents()
    return any(name in each for each in (known_controllers(), agents, recipes(agents), FORMER))


def unknown(name: str, argument: str = "controller", others: str = "") -> Refused:
    """What is said of a name that leads to nobody: who is known, or ``others``, and who has an id like it."""
    laws, agents = known_controllers(), shipped_agents()
    known = f"one of {', '.join(laws)}, of the agents that ship, {', '.join(agents)}"
    allowed = f"{others}, or {known}" if others else f"{known}, or the folder of a trained agent"
    return Refused(argument, name, allowed, meant(name, [*laws, *agents, *recipes(agents)], recipes(agents)))
