"""The training runs in a folder: of a training that made several, and of trainings that differ in nothing but their seeds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from train.shared import curve
from train.shared.files import as_path, read_json

AGENT = "agent.json"


def runs_in(folder: Path) -> Mapping[str, Path]:
    """The folders of all runs by their names, in their order; {"": folder} if the folder is that of one agent, or of none.

    A training of several runs has a folder for each, called by a number. A folder of several trainings of one agent on one
    scenario, as ``beamenv train --seed 0 --seed 1 --folder mine`` leaves it, has the runs of all. ``ValueError`` names the
    trainings in a folder that are of several agents or scenarios.
    """
    folder = as_path("folder", folder)
    if (folder / AGENT).exists():
        return {"": folder}
    return _numbered(folder) or _of_trainings(folder) or {"": folder}


def best_run(folder: Path) -> Path:
    """The folder of the run that ended its training at the least cost, by its learning curve; the first where there is none.

    ``ValueError`` names a curve that is damaged.
    """
    places = list(runs_in(folder).values())
    return min(places, key=curve.kept_cost) if len(places) > 1 else places[0]


def _numbered(folder: Path) -> dict[str, Path]:
    found = {path.parent.name: path.parent for path in folder.glob(f"*/{AGENT}") if path.parent.name.isdecimal()}
    return {name: found[name] for name in sorted(found, key=lambda name: (int(name), name))}


def _of_trainings(folder: Path) -> dict[str, Path]:
    """By training and, of one that made several, its number; none unless there are several trainings."""
    homes = {path.parent if not path.parent.name.isdecimal() else path.parent.parent for path in _agents(folder)}
    if len(homes) < 2:
        return {}
    runs = {home.name: {"": home} if (home / AGENT).exists() else _numbered(home) for home in sorted(homes)}
    kinds = {_trained_on(next(iter(each.values()))): name for name, each in runs.items()}
    if len(kinds) > 1:
        told = " and ".join(f"{name} of {agent} on {scenario}" for (agent, scenario), name in kinds.items())
        raise ValueError(f"folder = {str(folder)!r} holds trainings of several kinds, {told}: name one of them.")
    return {f"{name}{run and '-'}{run}": place for name, each in runs.items() for run, place in each.items()}


def _agents(folder: Path) -> list[Path]:
    """The files of agents in a folder's folders, and in those of numbers in these."""
    inner = [path for path in folder.glob(f"*/*/{AGENT}") if path.parent.name.isdecimal()]
    return [*folder.glob(f"*/{AGENT}"), *inner]


def _trained_on(folder: Path) -> tuple[str, str]:
    """An agent and its scenario, as its file tells."""
    about = read_json(folder / AGENT)
    told = about if isinstance(about, dict) else {}
    return str(told.get("agent", "an agent of its own")), str(told.get("scenario", "what it does not tell"))
