"""Recipes as TOML files: their names are those of the files."""

from importlib.resources import files

NAMES: tuple[str, ...] = tuple(
    sorted(entry.name.removesuffix(".toml") for entry in files(__name__).iterdir() if entry.name.endswith(".toml"))
)
"""Of the recipes that ship with the package."""
