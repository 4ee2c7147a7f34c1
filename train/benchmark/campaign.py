"""The benchmark: every controller in every scenario on the same held-out episodes."""

from __future__ import annotations

import json
import unicodedata
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from beamenv.blade.config import BladeConfig
from beamenv.blade.files import to_dict
from beamenv.configuration import Count, FileName, Flag, Refused, Table, Texts, checked, checked_table, clause, shown
from beamenv.configuration.files import ENDINGS
from beamenv.plant.spread import Spread
from beamenv.scenarios.named import expanded
from beamenv.scenarios.scenario import Scenario, scenario
from beamenv.task import resolve_task
from train.benchmark.applicable import applicable
from train.benchmark.bench import Setting
from train.benchmark.cells import Cell, Job, read_cell, write_cell
from train.benchmark.claim import RUNS, claim
from train.benchmark.listed import ListedController, listed_controllers
from train.benchmark.runner import run
from train.benchmark.showing.report import write_files
from train.benchmark.table import BenchmarkTable, tabulate
from train.controllers.shipped import FOLDER
from train.shared.files import as_path, check_folder
from train.shared.held_models import held_models
from train.shared.held_out import SEEDS
from train.shared.lock import alone_in
from train.shared.versions import versions
from train.workers.workers import Workers

Progress = Callable[[int, int, Cell], None]
Recording = Callable[[int, int, str], None]
"""Told how many controllers the episode of ``report.html`` is recorded under, of how many, and whose turn it is."""

ARGUMENTS = ("preset", "speed", "blade", "design", "duration", "physical_units", "max_episode_steps", "plant", "spread")
"""Of the environment, that all cells may share; the scenario is each cell's own."""


def benchmark(
    own: Mapping[str, Any] | None = None,
    *,
    scenarios: Sequence[str] | None = None,
    controllers: Sequence[str] | None = None,
    seeds: int = 128,
    runs: int | None = None,
    folder: Path | None = None,
    models: Sequence[Path] = (),
    trusted: bool = False,
    jobs: int | None = None,
    cluster: str | None = None,
    trained: Path = FOLDER,
    environment: Mapping[str, Any] | None = None,
    validation: bool = False,
    progress: Progress | None = None,
    recording: Recording | None = None,
) -> BenchmarkTable:
    """Run controllers in scenarios and return the table of results, which is also written to ``folder`` if one is given.

    - ``own``: objects with Stable-Baselines3's ``predict``, or plain functions, by the names they are to have. They are given the
      readings (N, p) of N blades; an SB3 model trained behind ``beamenv.SensorHistory`` is shown what it was trained to see.
    - ``scenarios``: names, files, and the groups "benchmark", "open", "unseen" and "all"; "all" if None. One that cannot be read is
      refused in one sentence, and the others go on.
    - ``controllers``: names of controllers and shipped agents, all of them if None. No control and LQG are always among them.
    - ``seeds``: held-out episodes, equal for every controller.
    - ``runs``: of each agent that many of its training runs, the first ones; all of them if None.
    - ``models``: files of SB3 models. Loading one may run code that is in it: ``trusted`` says that you know where they are from.
    - ``jobs``: number of parallel processes, to which your objects must be able to travel; by default only this one.
    - ``cluster``: HOST:PORT or ray://HOST:PORT of a Ray cluster whose processes do it, or "local" for one that is started here; as
      many as it has processors if ``jobs`` is left out.
    - ``environment``: further keyword arguments of the environment, such as a "blade".
    - ``validation``: run on the seeds and the bank of plants for choosing controllers, instead of those for comparing them.
    - ``progress``: called with cells done, their number, and the cell.
    - ``recording``: called as the page's episode is recorded, with controllers done, their number, and the next one's name.

    With a model of your own, "plant" in ``environment``, controllers and scenarios that it does not allow are left out; the table's
    ``left_out`` says why. If you name one of them, it is refused before anything runs.

    A folder that holds cells of an earlier run is resumed: a cell is kept unless something it depends on has changed.
    A failure stays in its own cell. Raises ValueError for unknown controllers, untrusted models, fewer than 2 seeds, when
    no scenario is left, for a folder with a benchmark of other settings, which it would replace, and for one in which nothing can
    be written or another process is at work.
    """
    seeds, workers, trusted = checked("seeds", seeds, SEEDS), Workers(jobs, cluster), checked("trusted", trusted, Flag())
    progress, validation = checked_progress(progress), checked("validation", validation, Flag())
    if recording is not None and not callable(recording):
        raise Refused("recording", recording, "None, or a function of controllers done, their number, and a name")
    runs = None if runs is None else checked("runs", runs, Count())
    arguments = environment_json({} if environment is None else environment)
    own = checked("own", {} if own is None else own, Table())
    controllers = None if controllers is None else checked("controllers", controllers, Texts())
    scenarios = None if scenarios is None else checked("scenarios", scenarios, Texts())
    folder, trained = None if folder is None else as_path("folder", folder), as_path("trained", trained)
    models = [Path(each) for each in checked("models", models, Texts())]
    if folder is not None:
        check_folder(folder)
    listed = [each.first(runs) for each in listed_controllers(controllers, own, models, trusted, trained)]
    asked = {*(scenarios or ()), *(controllers or ())}
    options: dict[str, Any] = {"workers": workers, "arguments": arguments, "validation": validation, "progress": progress}
    options["recording"] = recording
    return of_listed(listed, scenarios, seeds, folder, asked=asked, **options)


def checked_progress(progress: Any) -> Progress | None:
    """None, or something to call."""
    if progress is not None and not callable(progress):
        raise Refused("progress", progress, "None, or a function of cells done, their number, and the cell")
    found: Progress | None = progress
    return found


def of_listed(
    listed: Sequence[ListedController],
    scenarios: Sequence[str] | None,
    seeds: int,
    folder: Path | None,
    *,
    workers: Workers = Workers(),  # noqa: B008 - frozen
    arguments: str = "{}",
    validation: bool = False,
    progress: Progress | None = None,
    recording: Recording | None = None,
    asked: Collection[str] = (),
) -> BenchmarkTable:
    """The same of controllers that are listed already, and of the environment's ``arguments`` as JSON; of a model of one's own what
    is ``asked`` for by its name must be had.
    """
    known, refused = read_scenarios(scenarios)
    environment = json.loads(arguments)
    fit = None if environment.get("plant") is None else applicable(known, listed, environment, _titles(asked))
    known = known if fit is None else {name: known[name] for name in fit.tasks}
    settings = [Setting(name, each, seeds, arguments, validation) for name, each in known.items()]
    queue = [job for setting in settings for each in listed for job in jobs_of(each, setting)]
    if fit is not None:
        queue = [job for job in queue if (job.setting.name, job.controller) not in fit.without]
        listed = [each for each in listed if each.name in {job.controller for job in queue}]
    check_paths(queue)
    made = configuration(settings, listed)
    with nullcontext() if folder is None else alone_in(folder):
        if folder is not None:
            claim(folder, made)
        cells = _cells(queue, folder, workers, progress or (lambda done, total, cell: None))
        table = replace(tabulate(cells, listed, refused, made), left_out=() if fit is None else fit.sentences)
        if folder is not None:
            write_all(folder, table, listed, recording)
    return table


def jobs_of(listed: ListedController, setting: Setting) -> list[Job]:
    """The cells of one controller in one scenario, one for each training run."""
    return [Job(setting, listed.name, run, source) for run, source in listed.runs(setting.name, setting.scenario).items()]


def check_paths(queue: Sequence[Job]) -> None:
    """``ValueError`` for two cells that would have one file, also where capital letters are the same as small ones."""
    known: dict[str, Job] = {}
    for job in queue:
        other = known.setdefault(unicodedata.normalize("NFC", str(job.path)).casefold(), job)
        if other is not job:
            ours, theirs = str(job.path), str(other.path)
            raise ValueError(
                f"own gives two cells one file, {theirs!r} and {ours!r}: give one controller or scenario another name."
            )


def environment_json(environment: Any) -> str:
    """The environment's arguments as JSON; ``ValueError`` for unknown ones, and for a blade that would fail in every cell."""
    given = checked_table("environment", environment, ARGUMENTS)
    resolve_task(**{name: value for name, value in given.items() if name != "max_episode_steps"})
    if given.get("max_episode_steps") is not None:
        checked("environment.max_episode_steps", given["max_episode_steps"], Count())
    given = held_models(given)
    try:
        return json.dumps(given, sort_keys=True, default=_plain)
    except (TypeError, ValueError) as error:
        raise ValueError(f"environment is not allowed, for a cell's file could not hold it: {clause(error)}.") from None


def _plain(value: Any) -> Any:
    """What JSON does not know of itself: configurations, and NumPy's numbers and arrays."""
    if isinstance(value, BladeConfig):
        return to_dict(value)
    if isinstance(value, Spread):
        return asdict(value)
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{shown(value)} is of type {type(value).__name__}")


def read_scenarios(names: Sequence[str] | None) -> tuple[dict[str, Scenario], dict[str, str]]:
    """Scenarios by name, files by that of the file, and what is wrong with those that cannot be read; all of them if None."""
    read = {name: _read(name) for name in expanded(["all"] if names is None else names)}
    titles = {name: _title(name) for name in read}
    known = {checked("scenario", titles[name], FileName()): each for name, each in read.items() if isinstance(each, Scenario)}
    refused = {name: each for name, each in read.items() if isinstance(each, str)}
    if doubled := [name for name in read if list(titles.values()).count(titles[name]) > 1]:
        raise ValueError(f"scenarios {' and '.join(doubled)} have the same name: rename the file.")
    if not known:
        raise ValueError(" ".join(refused.values()) or "scenarios is empty, but a benchmark needs at least one.")
    return known, refused


def _title(name: str) -> str:
    return Path(name).stem if name.endswith(ENDINGS) else name


def _titles(names: Collection[str]) -> set[str]:
    return {_title(name) for name in names}


def _read(name: str) -> Scenario | str:
    try:
        return scenario(name)
    except ValueError as error:
        return str(error)


def _cells(queue: Sequence[Job], folder: Path | None, workers: Workers, progress: Progress) -> list[Cell]:
    """The cells of the queue, in its order: what is there already, and what is measured now, each written when it is whole."""
    kept = {job: cell for job in queue if folder is not None and (cell := read_cell(folder, job)) is not None}
    missing = [job for job in queue if job not in kept]

    def finished(job: Job, cell: Cell) -> None:
        kept[job] = cell
        if folder is not None:
            write_cell(folder, job, cell)
        progress(len(kept), len(queue), cell)

    run(missing, workers, finished)
    return [kept[job] for job in queue]


def configuration(settings: Sequence[Setting], listed: Sequence[ListedController]) -> dict[str, Any]:
    """How the table was made, as JSON can hold it."""
    seeds = settings[0].episodes
    return {
        "seeds": [seeds[0], seeds[-1]],
        "environment": json.loads(settings[0].arguments),
        "scenarios": {setting.name: setting.scenario.to_dict() for setting in settings},
        "controllers": {each.name: about(each) for each in listed},
        "versions": versions(),
    }


def about(listed: ListedController) -> dict[str, Any]:
    """What a configuration tells of a controller; of runs only where not all of an agent's take part."""
    return {"kind": listed.kind, "tier": listed.tier, **({} if listed.at_most is None else {RUNS: listed.at_most})}


def write_all(folder: Path, table: BenchmarkTable, listed: Sequence[ListedController], recording: Recording | None = None) -> None:
    """Tables, heat map and page, whose episode is recorded under those that are ``listed``."""
    from train.benchmark.showing.heat_map import heat_map
    from train.benchmark.showing.page import write_report
    from train.figures.paper import save
    from train.figures.paper_heat_map import heat_map as drawn

    write_files(folder, table)
    save(drawn(heat_map(table)), folder / "heat_map.png")
    write_report(folder / "report.html", table, listed, recording)
