"""One's own entry of the leaderboard: run again in every scenario, and entered if it has been through all of them."""

from __future__ import annotations

import os
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import numpy as np

from baselines import Estimate
from beamenv.configuration import Count, FileName, Flag, Number, Refused, Text, checked
from beamenv.configuration.files import of_file
from beamenv.configuration.near import meant
from beamenv.knowledge import TRUTH
from train.benchmark.bench import Setting
from train.benchmark.campaign import Progress, Recording, checked_progress, jobs_of, of_listed, read_scenarios
from train.benchmark.leaderboard import NAME, Entry, check_entry, enter
from train.benchmark.listed import ListedController, agents, listed_controllers, of_folder
from train.benchmark.score import SPLITS, aggregates
from train.benchmark.table import CLAIRVOYANT, BenchmarkTable, Row
from train.controllers.models import UNTRUSTED
from train.controllers.named import discover
from train.controllers.policy_files import read_about
from train.controllers.runs import AGENT
from train.controllers.shipped import FOLDER
from train.controllers.sources import Classical, ModelFile, Trained
from train.controllers.tiers import LEARNT
from train.shared.digests import digest
from train.shared.files import as_path, check_file, check_folder
from train.shared.versions import versions
from train.workers.workers import Workers

SCENARIOS = ("all",)
SEEDS = 128
ENVIRONMENT = "{}"
"""What every entry is put through, for rows must be comparable: all scenarios, as many episodes, the default environment."""

MODEL = ".zip"
"""Ending of a model file of Stable-Baselines3."""

DIGITS = 6
"""Of numbers in a row."""


def submit(
    entry: str,
    leaderboard: Path = Path("results"),
    *,
    folder: Path | None = None,
    tier: int | None = None,
    trusted: bool = False,
    overwrite: bool = False,
    jobs: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
    recording: Recording | None = None,
) -> tuple[Entry, BenchmarkTable]:
    """Run an entry in all scenarios beside no control, LQG and the clairvoyant law, and append its row to the leaderboard.

    - ``entry``: the name of a controller or of an agent that ships and acts everywhere, the folder of a trained agent or of its
      runs, or a ``.zip`` file of Stable-Baselines3. Loading the last may run code: ``trusted`` says that you know where it is from.
    - ``leaderboard``: the folder of ``leaderboard.csv`` and ``leaderboard.md``.
    - ``folder``: where the run's cells, tables and page are written; an earlier one's are resumed.
    - ``tier``: of information, 0, 1 or 2; what the entry says of itself if None, and else ``LEARNT``.
    - ``overwrite``: whether to replace another entry of this name.
    - ``jobs``, ``cluster``: who measures, as in ``benchmark``; so are ``progress`` and ``recording``.

    Raises ValueError of one sentence, and leaves the leaderboard as it is, for what is none of these, an entry of tier 3, one that
    is on the leaderboard already, and one that could not be measured in every scenario.
    """
    entry = checked("submit", entry, Text())
    workers, trusted, overwrite = (
        Workers(jobs, cluster),
        checked("trusted", trusted, Flag()),
        checked("overwrite", overwrite, Flag()),
    )
    tier = None if tier is None else checked("tier", tier, Count(0, TRUTH - 1))
    place, folder = as_path("leaderboard", leaderboard) / NAME, None if folder is None else as_path("folder", folder)
    listed = entrant(entry, tier, trusted)
    trained = seconds(listed)
    settings = [Setting(name, each, SEEDS, ENVIRONMENT) for name, each in read_scenarios(SCENARIOS)[0].items()]
    mark = digest(*(job.digest().encode() for setting in settings for job in jobs_of(listed, setting)))
    check_file(place, "leaderboard")
    check_entry(place, listed.name, mark, overwrite)
    if folder is not None:
        check_folder(folder)
    beside = [each for each in listed_controllers([CLAIRVOYANT], {}, [], False) if each.name != listed.name]
    table = of_listed(
        [*beside, listed],
        SCENARIOS,
        SEEDS,
        folder,
        workers=workers,
        arguments=ENVIRONMENT,
        progress=checked_progress(progress),
        recording=recording,
    )
    row = Entry({**measured(table, listed), "training_seconds": trained, "digest": mark, **today()})
    enter(place, row, overwrite)
    return row, table


def entrant(entry: str, tier: int | None, trusted: bool) -> ListedController:
    """What an entry is; ``ValueError`` of one sentence for what it is not."""
    known = discover()
    general = {each.name: each for each in agents(FOLDER) if each.everywhere}
    if entry in known:
        return _named(ListedController(entry, known[entry].kind, known[entry].tier, {"": Classical(known[entry])}), tier)
    if entry in general:
        return _named(general[entry], tier)
    path = as_path("submit", entry)
    if path.suffix == MODEL:
        brought = _model(path, tier, trusted)
    elif os.path.isdir(entry):  # of the empty text the path would be the current folder
        brought = of_folder(path, tier)
    else:
        others = f"the folder of a trained agent, a model's {MODEL} file, or one of {', '.join([*known, *general])}"
        raise Refused("submit", entry, others, meant(entry, [*known, *general]))
    if brought.name in {*known, *general}:
        raise Refused("submit", entry, f"called otherwise: {brought.name!r} is a controller that ships")
    return brought


def _named(listed: ListedController, tier: int | None) -> ListedController:
    if listed.tier >= TRUTH:
        raise Refused("submit", listed.name, f"of tier 0, 1 or 2: tier {TRUTH} is told the episode's truth, and is no rival")
    if tier is not None and tier != listed.tier:
        raise Refused("tier", tier, f"{listed.tier}, which {listed.name} has, or be left out")
    return listed


def _model(path: Path, tier: int | None, trusted: bool) -> ListedController:
    name = checked("submit", path.stem, FileName())
    if not trusted:
        raise ValueError(f"submit = {str(path)!r} is not loaded: {UNTRUSTED}")
    if not path.is_file():
        raise Refused("submit", str(path), "a file that is there")
    return ListedController(name, "learned", LEARNT if tier is None else tier, {"": ModelFile(path)})


def measured(table: BenchmarkTable, listed: ListedController) -> dict[str, Any]:
    """What the row tells of the run; ``ValueError`` with the first reason why the entry was not measured in every scenario."""
    rows = [row for name in table.scenarios if (row := table.row(name, listed.name)) is not None]
    runs = len(listed.everywhere)
    if missing := [row for row in rows if row.runs < runs]:
        first = missing[0]
        raise ValueError(
            f"submit = {listed.name!r} is not entered, for it could not be measured in {len(missing)} of {len(rows)} scenarios: "
            f"in {first.scenario} {' '.join(first.sentences)}"
        )
    about = {"name": listed.name, "tier": listed.tier, "kind": listed.kind, "runs": runs}
    unstable = float(np.mean([row.estimates["unstable"].value for row in rows]))
    return {**about, **costs(rows), **scores(table, listed.name), "unstable": _short(unstable), "seeds": rows[0].seeds}


def costs(rows: list[Row]) -> dict[str, float | None]:
    """Of each split the mean over its scenarios of J / J₀."""
    of = {split: [row.estimates["relative_cost"].value for row in rows if row.scenario in names] for split, names in SPLITS.items()}
    return {f"cost {split}": _short(float(np.mean(values))) if values else None for split, values in of.items()}


def scores(table: BenchmarkTable, name: str) -> dict[str, float | None]:
    """Of each split the score with its interval, None where there is none."""
    found: dict[str, Estimate] = {each.split: each.score for each in aggregates(table) if each.controller == name}
    ends = {"": "value", " low": "low", " high": "high"}
    return {
        f"score {split}{end}": _short(getattr(found[split], field)) if split in found else None
        for split in SPLITS
        for end, field in ends.items()
    }


def seconds(listed: ListedController) -> float | None:
    """Of training a run, the mean of what their files tell; None where they do not, ``ValueError`` for what is no duration."""
    places = [source.folder for source in listed.everywhere.values() if isinstance(source, Trained)]
    known = [each for place in places if (each := _seconds(place)) is not None]
    return _short(float(np.mean(known))) if known and len(known) == len(listed.everywhere) else None


def _seconds(folder: Path) -> float | None:
    about = read_about(folder)
    with of_file(folder / AGENT):
        return checked("seconds", about["seconds"], Number(ge=0.0)) if about.get("seconds") is not None else None


def today() -> dict[str, str]:
    """When, and with what."""
    made = ", ".join(f"{name} {version}" for name, version in versions().items())
    return {"versions": made, "date": datetime.now(timezone.utc).date().isoformat()}


def _short(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
