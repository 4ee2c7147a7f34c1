"""Recipes as TOML files: their names are those of the files."""

from importlib.resources import files

from beamenv.configuration.files import parsed_table

NAMES: tuple[str, ...] = tuple(
    sorted(entry.name.removesuffix(".toml") for entry in files(__name__).iterdir() if entry.name.endswith(".toml"))
)
"""Of the recipes that ship with the package."""


def title(agent: str, otherwise: str) -> str:
    """What an agent is, in a sentence, by its id or its recipe's name: its recipe's title today, or ``otherwise`` without one."""
    name = next((name for name in (agent, agent.rpartition("-")[0]) if name in NAMES), None)
    if name is None:
        return otherwise
    file = files(__name__).joinpath(f"{name}.toml")
    return f"{parsed_table(file.read_text(encoding='utf-8'), file.name)['title']}."
