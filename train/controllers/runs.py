"""The training runs in a folder: of one training that made several, each is an agent in a folder of its number."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from train.shared import curve
from train.shared.files import as_path

AGENT = "agent.json"


def runs_in(folder: Path) -> Mapping[str, Path]:
    """The folders of all runs by their numbers, in their order; {"": folder} if the folder is that of one agent, or of none."""
    folder = as_path("folder", folder)
    found = {path.parent.name: path.parent for path in folder.glob(f"*/{AGENT}") if path.parent.name.isdecimal()}
    if (folder / AGENT).exists() or not found:
        return {"": folder}
    return {name: found[name] for name in sorted(found, key=lambda name: (int(name), name))}


def best_run(folder: Path) -> Path:
    """The folder of the run that ended its training at the least cost, by its learning curve; the first where there is none.

    ``ValueError`` names a curve that is damaged.
    """
    places = list(runs_in(folder).values())
    return min(places, key=curve.kept_cost) if len(places) > 1 else places[0]
