"""The blade of the page as a file that ``--blade`` reads."""

from __future__ import annotations

import json
from typing import Any

from beamenv.blade.config import ON_EVERY_WALL, BladeConfig
from beamenv.blade.files import from_dict, to_dict
from beamenv.blade.presets import THESIS
from beamenv.configuration.cache import departing
from beamenv.configuration.files import parsed_table
from train.shared.toml import as_toml

NAMES = TOML, JSON = "blade.toml", "blade.json"
SAYS = """A blade from `beamenv explore`. Fields that are left out are those of the preset thesis.
The weights of LQG are no part of it."""


def saved(blade: BladeConfig) -> tuple[str, str]:
    """The name of a blade's file and what stands in it: TOML, or JSON where a field is None that TOML has no word for."""
    table: dict[str, Any] = departing(to_dict(blade), to_dict(THESIS))
    if walls := table.get("beam", {}).get("ply_angles_deg"):
        by_wall = dict(walls)
        table["beam"]["ply_angles_deg"] = by_wall.get(ON_EVERY_WALL, by_wall)
    text = as_toml(table, SAYS)
    return (TOML, text) if _says(text, blade) else (JSON, json.dumps(table, indent=2) + "\n")


def _says(text: str, blade: BladeConfig) -> bool:
    try:
        return from_dict(parsed_table(text, TOML)) == blade
    except ValueError:  # a field that cannot be left out
        return False
