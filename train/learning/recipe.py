"""Recipes: a file says which trainer, with which settings and for how many updates."""

from __future__ import annotations

from dataclasses import asdict, replace
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

from beamenv.configuration import Choice, Refused, Text, Whole, checked, checked_table, configuration, read
from beamenv.configuration.files import of_file, parsed_table, read_table
from train.learning import recipes
from train.learning.agents import AGENTS
from train.learning.recipes import NAMES

KEYS = ("agent", "title", "updates", "settings")
NAME = Choice(NAMES)
AGENT = Choice(tuple(AGENTS))


@configuration("recipe")
class Recipe:
    """What is trained, and how."""

    agent: Annotated[str, AGENT]
    """Short name of the trainer."""
    title: Annotated[str, Text()]
    """What it is, in a sentence."""
    updates: Whole
    """Of the shipped run."""
    settings: Any
    """The trainer's settings dataclass."""

    def on(self, device: str) -> Recipe:
        """The same on a device of torch; ``ValueError`` for what is trained on the processor alone."""
        if not hasattr(self.settings, "device"):
            raise Refused("device", device, f"left out: {self.agent} trains on the processor")
        return replace(self, settings=replace(self.settings, device=device))

    def to_dict(self) -> dict[str, Any]:
        """Every setting written out, as JSON can hold it."""
        return {"agent": self.agent, "title": self.title, "updates": self.updates, "settings": asdict(self.settings)}


def named_recipe(name: str) -> Recipe:
    """A recipe that ships with the package; ``ValueError`` lists them."""
    file = files(recipes).joinpath(f"{checked('agent', name, NAME)}.toml")
    return parsed(file.read_text(encoding="utf-8"), file.name)


def load_recipe(path: Path) -> Recipe:
    """The recipe in a TOML or JSON file; ``ValueError`` names the file and what is wrong in it."""
    return _recipe(read_table(path), str(path))


def parsed(text: str, source: str) -> Recipe:
    """The recipe in the text of a file; ``ValueError`` names what is wrong in ``source``."""
    return _recipe(parsed_table(text, source), source)


def _recipe(content: dict[str, Any], source: str) -> Recipe:
    """All keys must be there, and of the settings those that are not the trainer's own."""
    with of_file(source):
        return _read(checked_table("recipe", content, KEYS))


def _read(content: dict[str, Any]) -> Recipe:
    if missing := [key for key in KEYS if key not in content]:
        raise ValueError(f"recipe.{missing[0]} is missing: a recipe has {', '.join(KEYS)}.")
    agent = checked("recipe.agent", content["agent"], AGENT)
    settings = read(AGENTS[agent].settings(), content["settings"], "recipe.settings")
    return Recipe(agent, content["title"], content["updates"], settings)
