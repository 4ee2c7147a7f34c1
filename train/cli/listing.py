"""The command ``beamenv list``: everything with an id, what it is, and how to get it in Python."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Any

import typer
from rich.console import Console

from train.cli.options import JsonOption, note, one_sentence, print_json, say
from train.cli.tables import GAP, Column, show_table

LEAST = 30
"""Columns of the text that says what something is, however narrow the terminal."""


class Kind(str, Enum):
    """What has ids."""

    controllers = "controllers"
    agents = "agents"
    scenarios = "scenarios"
    presets = "presets"


@dataclass(frozen=True, slots=True)
class Listed:
    """All of a kind."""

    rows: Sequence[dict[str, Any]]
    """Each with its "id", "title" and "python", and what else there is to tell."""
    shown: Sequence[str]
    """What the table shows between id and title."""
    note: str
    """Below the table: what its columns say."""
    example: str
    """How one of them is had in Python."""


def list_ids(
    kind: Annotated[Kind, typer.Argument(help="What to list.")],
    as_json: JsonOption = False,
) -> None:
    """List every controller, agent, scenario or preset: its id, what it is and knows, and how to get it in Python."""
    with one_sentence():
        found = LISTS[kind]()
    if as_json:
        print_json(list(found.rows))
    else:
        _show(kind.value, found)


def controllers() -> Listed:
    """Those that are built."""
    from train.controllers.known import known_controllers

    rows = [
        {"id": each.id, "title": each.title, "kind": each.kind, "tier": each.tier, "told": each.told, "python": each.python}
        for each in known_controllers().values()
    ]
    return Listed(rows, ("tier",), _tiers(), f'{CONTROLLER}; controller("lqg", env)')


def agents() -> Listed:
    """Those that ship."""
    from train.controllers.known import known_agents
    from train.learning.recipes import title

    rows = [
        {
            "id": each.id,
            "title": title(each.id, each.title),
            "tier": each.tier,
            "told": each.told,
            "scenarios": list(each.scenarios),
            "runs": list(each.runs),
            "python": each.python,
        }
        for each in known_agents().values()
    ]
    note = (
        "A generalist was trained on several scenarios at once and takes part in all; a specialist was trained on each scenario "
        "named above, and takes part in those alone. All agents are of tier 1."
    )
    return Listed(rows, ("runs",), note, f'{CONTROLLER}; controller("residual-generalist", env, trained_seed=0)')


def scenarios() -> Listed:
    """Those with a name."""
    from beamenv.scenarios.named import GROUPS, NAMES, titles

    rows = [
        {
            "id": name,
            "title": title,
            "in": [group for group, members in GROUPS.items() if name in members and group != "all"],
            "python": f'gym.make("beamenv/RotatingBeam-{name}-v0")'
            if name in NAMES
            else f'gym.make("beamenv/RotatingBeam-v0", scenario="{name}")',
        }
        for name, title in titles().items()
    ]
    groups = "In: the scenario's groups, which beamenv benchmark --scenario takes too. No agent was trained on those in unseen."
    return Listed(rows, ("in",), groups, 'gym.make("beamenv/RotatingBeam-v0", scenario="delay")')


def presets() -> Listed:
    """Those of blades."""
    from beamenv.titles import BLADES

    rows = [
        {"id": name, "title": title, "python": f'gym.make("beamenv/RotatingBeam-v0", preset="{name}")'}
        for name, title in BLADES.items()
    ]
    return Listed(rows, (), "", 'gym.make("beamenv/RotatingBeam-v0", preset="sound-blade")')


CONTROLLER = "from beamenv.train.controllers import controller"

LISTS: dict[Kind, Callable[[], Listed]] = {
    Kind.controllers: controllers,
    Kind.agents: agents,
    Kind.scenarios: scenarios,
    Kind.presets: presets,
}


def _tiers() -> str:
    from beamenv.titles import TIERS

    told = ", ".join(f"{tier} {what}" for tier, what in TIERS.items())
    return f"Tier: what the controller is told, besides what lower tiers are told: {told}."


def _show(kind: str, found: Listed) -> None:
    """Ids are never cut; what each is takes as many lines as it needs beside them."""
    heads = [kind.removesuffix("s"), *found.shown]
    cells = [[row["id"], *(_text(row[column]) for column in found.shown)] for row in found.rows]
    taken = sum(max(len(each) for each in column) + GAP for column in zip(heads, *cells, strict=True))
    room = max(Console().width - taken, LEAST)
    rows = [[*own, textwrap.fill(_title(row), room)] for own, row in zip(cells, found.rows, strict=True)]
    show_table([*(Column(each, words=True) for each in heads), Column("what it is", words=True)], rows)
    if found.note:
        note(found.note)
    say(f"In Python: {found.example}")


def _title(row: dict[str, Any]) -> str:
    return row["title"] + (f" Trained on {', '.join(row['scenarios'])}." if row.get("scenarios") else "")


def _text(value: Any) -> str:
    """Of several their names, of seeds in a row the first and the last."""
    if isinstance(value, list) and len(value) > 2 and value == list(range(value[0], value[-1] + 1)):
        return f"{value[0]}–{value[-1]}"
    return ", ".join(map(str, value)) if isinstance(value, list) else "–" if value is None else str(value)
