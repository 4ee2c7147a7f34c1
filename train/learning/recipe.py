"""Recipes: a file says which trainer, with which settings and for how many updates."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, is_dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Any

from train.learning import recipes
from train.learning.agents import AGENTS

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

NAMES: tuple[str, ...] = tuple(
    sorted(entry.name.removesuffix(".toml") for entry in files(recipes).iterdir() if entry.name.endswith(".toml"))
)
"""Of the recipes that ship with the package."""

KEYS = ("agent", "title", "updates", "settings")


@dataclass(frozen=True, slots=True)
class Recipe:
    """What is trained, and how."""

    agent: str
    """Short name of the trainer."""
    title: str
    """What it is, in a sentence."""
    updates: int
    """Of the shipped run."""
    settings: Any
    """The trainer's settings dataclass."""

    def to_dict(self) -> dict[str, Any]:
        """Every setting written out, as JSON can hold it."""
        return {"agent": self.agent, "title": self.title, "updates": self.updates, "settings": asdict(self.settings)}


def named_recipe(name: str) -> Recipe:
    """A recipe that ships with the package; ``ValueError`` lists them."""
    if name not in NAMES:
        raise ValueError(f"agent = {name!r} must be one of {', '.join(NAMES)}.")
    return parsed(files(recipes).joinpath(f"{name}.toml").read_text(encoding="utf-8"), f"{name}.toml")


def load_recipe(path: Path) -> Recipe:
    """The recipe in a TOML file; ``ValueError`` if it cannot be read or is none."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"recipe file {str(path)!r} cannot be read: {error}.") from None
    return parsed(text, str(path))


def parsed(text: str, source: str) -> Recipe:
    """The recipe in the text of a TOML file; ``ValueError`` names what is wrong in ``source``."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"recipe file {source!r} cannot be read: {error}.") from None
    if wrong := sorted(set(content) ^ set(KEYS)):
        raise ValueError(f"recipe {source!r} has, or lacks, {wrong[0]!r}: its keys are {', '.join(KEYS)}.")
    agent, updates = content["agent"], content["updates"]
    if not isinstance(agent, str) or agent not in AGENTS:
        raise ValueError(f"recipe {source!r}: agent = {agent!r} must be one of {', '.join(AGENTS)}.")
    if isinstance(updates, bool) or not isinstance(updates, int) or updates < 1:
        raise ValueError(f"recipe {source!r}: updates = {updates!r} must be a positive whole number.")
    settings = changed(AGENTS[agent].settings(), content["settings"], f"recipe {source!r}: settings")
    return Recipe(agent, str(content["title"]), updates, settings)


def changed(settings: Any, given: Mapping[str, Any], table: str) -> Any:
    """The settings with those given changed, nested tables field by field; ``ValueError`` for an unknown one or another type."""
    known = [each.name for each in fields(settings)]
    if not isinstance(given, Mapping) or (unknown := sorted(set(given) - set(known))):
        wrong = "is not a table" if not isinstance(given, Mapping) else f"has the unknown field {unknown[0]!r}"
        raise ValueError(f"{table} {wrong}: its fields are {', '.join(known)}.")
    changes = {}
    for name, value in given.items():
        current = getattr(settings, name)
        if is_dataclass(current):
            changes[name] = changed(current, value, f"{table}.{name}")
            continue
        if isinstance(current, float) and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if type(value) is not type(current):
            raise ValueError(f"{table}.{name} = {value!r} must be a {type(current).__name__}, as {current!r} is.")
        changes[name] = value
    return replace(settings, **changes)
