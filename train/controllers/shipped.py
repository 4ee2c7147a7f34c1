"""The trained policies that ship with the package."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from beamenv.configuration import Count, Text, checked
from beamenv.plant.plant import Plant
from train.controllers.policies import Policy
from train.controllers.policy_files import load_policy
from train.shared.files import as_path

FOLDER = Path(__file__).parent / "trained"
"""<agent>/<scenario or generalist>/<seed>/ with ``agent.json``, ``weights.npz`` and ``learning.csv``."""


@dataclass(frozen=True, slots=True)
class Shipped:
    """One of them."""

    agent: str
    scenario: str
    seed: int
    folder: Path


def shipped(folder: Path = FOLDER) -> list[Shipped]:
    """All of them, by agent, scenario and seed."""
    homes = [path.parent for path in as_path("folder", folder).glob("*/*/*/agent.json") if path.parent.name.isdecimal()]
    found = [Shipped(home.parent.parent.name, home.parent.name, int(home.name), home) for home in homes]
    return sorted(found, key=lambda each: (each.agent, each.scenario, each.seed))


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
    return load_policy(find_shipped(agent, scenario, seed).folder, plant)
