"""A recipe as the text of a TOML file."""

from __future__ import annotations

from dataclasses import asdict

from beamenv.configuration.cache import departing
from train.learning.agents import AGENTS
from train.learning.recipe import Recipe
from train.shared import toml


def as_toml(recipe: Recipe, says: str = "") -> str:
    """What ``load_recipe`` reads as the same recipe: its settings that are not the trainer's own. What it ``says`` is a comment."""
    usual = asdict(AGENTS[recipe.agent].settings())
    head = {"agent": recipe.agent, "title": recipe.title, "updates": recipe.updates}
    return toml.as_toml({**head, "settings": departing(asdict(recipe.settings), usual)}, says)
