"""The trained policies that ship with the package: agents, each with an id and its training runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from beamenv.configuration import Count, Text, checked
from train.shared.files import as_path, read_json

if TYPE_CHECKING:
    from beamenv.plant.plant import Plant
    from train.controllers.policies import Policy

FOLDER = Path(__file__).parent / "trained"
"""<agent>/<scenario or generalist>/<seed>/ with ``agent.json``, ``weights.npz`` and ``learning.csv``."""

GENERALIST = "generalist"
"""Trained on every scenario at once, and therefore run in every one."""

SPECIALIST = "specialist"
"""Trained on one scenario, and run in that one alone; there may be one for each of several."""


@dataclass(frozen=True, slots=True)
class Shipped:
    """A training run."""

    agent: str
    scenario: str
    seed: int
    folder: Path


@dataclass(frozen=True, slots=True)
class Agent:
    """An agent that ships, a generalist or a specialist, with all of its training runs by their seeds."""

    id: str
    """As "residual-generalist" and "ppo-specialist"."""
    everywhere: Mapping[int, Shipped] = field(default_factory=dict)
    """Of a generalist."""
    only_in: Mapping[str, Mapping[int, Shipped]] = field(default_factory=dict)
    """Of a specialist, by scenario."""

    @property
    def title(self) -> str:
        """In a line: that of its recipe, as its first run tells it; empty where that tells none."""
        runs = self.everywhere or next(iter(self.only_in.values()))
        about = read_json(next(iter(runs.values())).folder / "agent.json")
        recipe = about.get("recipe") if isinstance(about, dict) else None
        title = recipe.get("title") if isinstance(recipe, dict) else None
        return f"{title}." if isinstance(title, str) and title else ""

    def runs(self, scenario: str) -> Mapping[int, Shipped]:
        """Those that are meant for a scenario; none where a specialist was not trained on it."""
        return self.everywhere or self.only_in.get(scenario, {})


def shipped(folder: Path = FOLDER) -> list[Shipped]:
    """All of them, by agent, scenario and seed."""
    homes = [path.parent for path in as_path("folder", folder).glob("*/*/*/agent.json") if path.parent.name.isdecimal()]
    found = [Shipped(home.parent.parent.name, home.parent.name, int(home.name), home) for home in homes]
    return sorted(found, key=lambda each: (each.agent, each.scenario, each.seed))


def shipped_agents(folder: Path = FOLDER) -> dict[str, Agent]:
    """The agents by their ids; what one recipe has trained is a generalist, a specialist, or both."""
    homes: dict[str, dict[str, dict[int, Shipped]]] = {}
    for each in shipped(folder):
        homes.setdefault(each.agent, {}).setdefault(each.scenario, {})[each.seed] = each
    found: dict[str, Agent] = {}
    for name, runs in homes.items():
        if general := runs.pop(GENERALIST, {}):
            found[f"{name}-{GENERALIST}"] = Agent(f"{name}-{GENERALIST}", general)
        if runs:
            found[f"{name}-{SPECIALIST}"] = Agent(f"{name}-{SPECIALIST}", only_in=runs)
    return found


def recipes(agents: Mapping[str, Agent]) -> dict[str, str]:
    """The ids of agents by the recipes that trained them: of two from one recipe the specialist's."""
    return {name.removesuffix(f"-{GENERALIST}").removesuffix(f"-{SPECIALIST}"): name for name in agents}


def find_shipped(agent: str, scenario: str, seed: int | None = None, folder: Path = FOLDER) -> Shipped:
    """That of an agent, a scenario and a training seed, the first if None; ``ValueError`` lists what there is."""
    every = shipped(folder)
    agent, scenario = checked("agent", agent, Text()), checked("scenario", scenario, Text())
    seed = None if seed is None else checked("seed", seed, Count(0))
    if agent not in {each.agent for each in every}:
        names = ", ".join(sorted({each.agent for each in every})) or "none at all"
        raise ValueError(f"agent = {agent!r} must be one of those that ship with the package: {names}.")
    own = [each for each in every if each.agent == agent and each.scenario == scenario]
    if not own:
        known = ", ".join(sorted({each.scenario for each in every if each.agent == agent}))
        raise ValueError(f"scenario = {scenario!r} must be one that the agent {agent!r} ships for: {known}.")
    if seed is None:
        return own[0]
    for each in own:
        if each.seed == seed:
            return each
    known = ", ".join(str(each.seed) for each in own)
    raise ValueError(f"seed = {seed!r} must be one that the agent {agent!r} ships for in {scenario!r}: {known}.")


def load_shipped(agent: str, scenario: str, seed: int | None = None, plant: Plant | None = None) -> Policy:
    """A policy that ships with the package, checked against the design plant it is to work on; see ``load_policy``."""
    from train.controllers.policy_files import load_policy  # an agent's name is found without what it is made of

    return load_policy(find_shipped(agent, scenario, seed).folder, plant)
