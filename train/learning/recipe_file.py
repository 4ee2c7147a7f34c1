"""A recipe as the text of a TOML file."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from beamenv.configuration.cache import departing
from train.learning.agents import AGENTS
from train.learning.recipe import Recipe


def as_toml(recipe: Recipe, says: str = "") -> str:
    """What ``load_recipe`` reads as the same recipe: its settings that are not the trainer's own. What it ``says`` is a comment."""
    usual = asdict(AGENTS[recipe.agent].settings())
    head = {"agent": recipe.agent, "title": recipe.title, "updates": recipe.updates}
    tables = _table("settings", departing(asdict(recipe.settings), usual))
    return "\n".join([*(f"# {line}" for line in says.splitlines()), *_lines(head), *tables, ""])


def _table(name: str, table: dict[str, Any]) -> Iterator[str]:
    """Its lines, and after them those of tables within it."""
    inner = {key: value for key, value in table.items() if isinstance(value, dict)}
    yield from ("", f"[{name}]", *_lines({key: value for key, value in table.items() if key not in inner}))
    for key, value in inner.items():
        yield from _table(f"{name}.{key}", value)


def _lines(table: dict[str, Any]) -> list[str]:
    return [f"{key} = {_value(value)}" for key, value in table.items()]


def _value(value: Any) -> str:
    """TOML's strings, booleans and lists are JSON's, and its numbers Python's."""
    return repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False)
