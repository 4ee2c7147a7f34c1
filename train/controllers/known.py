"""Every controller and every agent that ships by its id: what it is and what it is told, read from its files without building any.

A controller's id is its file's name in ``named``, an agent's that of its folder in ``trained`` with what it was trained for. They
are the same on the command line, in tables, in files and in Python: ``beamenv.train.controllers.controller(id, env)``.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from beamenv.titles import LEARNT, TIERS
from train.controllers.shipped import FOLDER, Agent, shipped_agents

NAMED = Path(__file__).parent / "named"

FORMER: Mapping[str, str] = MappingProxyType({"run-up-lqg": "spin-up-lqg"})
"""Ids that controllers once had, and that still mean them."""


@dataclass(frozen=True, slots=True)
class Known:
    """A controller or an agent."""

    id: str
    title: str
    """In a line."""
    kind: str
    """Of ``train.controllers.named.KINDS``, or "learned"."""
    tier: int | None
    """Of information; None where its file works it out."""
    scenarios: tuple[str, ...] = ()
    """That an agent was trained on alone; none of a generalist and of what is no agent."""
    runs: tuple[int, ...] = ()
    """Seeds of an agent's training runs; in some scenarios a specialist may have fewer."""

    @property
    def told(self) -> str:
        """What it knows besides what lower tiers do."""
        return "" if self.tier is None else TIERS.get(self.tier, "")

    @property
    def python(self) -> str:
        """How to get it for an environment."""
        return f'controller("{self.id}", env)'


def known_controllers(folder: Path = NAMED) -> dict[str, Known]:
    """All that have a file, in the order of their names."""
    files = sorted(path for path in folder.glob("*.py") if path.stem != "__init__")
    return {each.id: each for each in map(_of_file, files)}


def known_agents(folder: Path = FOLDER) -> dict[str, Known]:
    """All that ship, in the order of their names."""
    return {name: _of_agent(each) for name, each in shipped_agents(folder).items()}


def _of_file(path: Path) -> Known:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    told = {name: value for node in tree.body for name, value in _constants(node)}
    title = (ast.get_docstring(tree) or "").partition("\n")[0]
    tier = told.get("TIER")
    return Known(path.stem.replace("_", "-"), title, str(told.get("KIND", "")), tier if isinstance(tier, int) else None)


def _constants(node: ast.stmt) -> list[tuple[str, Any]]:
    """Names that a statement gives a number or a text."""
    if not isinstance(node, ast.Assign) or not isinstance(node.value, ast.Constant):
        return []
    return [(target.id, node.value.value) for target in node.targets if isinstance(target, ast.Name)]


def _of_agent(agent: Agent) -> Known:
    runs = sorted({seed for runs in (agent.everywhere, *agent.only_in.values()) for seed in runs})
    return Known(agent.id, agent.title, "learned", LEARNT, tuple(agent.only_in), tuple(runs))
