"""A tuning in a folder: begun or resumed, and the best recipe written."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from beamenv.configuration import Count, Refused, checked
from beamenv.configuration.writing import write_whole
from train.learning.job import Job
from train.learning.recipe import Recipe
from train.learning.recipe_file import as_toml
from train.learning.session import Budget
from train.learning.several import held
from train.learning.validation import EPISODES
from train.shared.cluster import CLIENT, LOCAL, check_address
from train.shared.files import on_one_line, read_json, write_csv, write_json
from train.shared.held_out import VALIDATION
from train.shared.interruption import ending_as_interrupted
from train.shared.lock import alone_in
from train.tuning.records import FAILED, Record, checkpoints, finished, keep, known, rows
from train.tuning.space import Space, drawn, value_of
from train.tuning.trial import rungs

ABOUT, RECIPE, TABLE = "tuning.json", "recipe.toml", "trials.csv"

TRIALS = Count(2, 10_000)
"""The recipe as it is, and others."""

Report = Callable[[Sequence[Record]], None]


@dataclass(frozen=True, slots=True)
class Tuning:
    """What is tuned, on what, by how many trials."""

    name: str
    """Of the recipe."""
    recipe: Recipe
    """``updates`` are those that every trial may have."""
    space: Space
    scenario: Any
    """As a ``Job`` has it."""
    seed: int
    """Of every training, and of what is drawn."""
    trials: int
    environment: Mapping[str, Any]

    def job(self, trial: int) -> Job:
        """What is trained in a trial; ``ValueError`` if the space leaves none."""
        recipe = drawn(self.recipe, self.space, self.seed, trial)
        return Job(self.name, recipe, self.scenario, self.seed, Budget(updates=recipe.updates), self.environment)

    def identity(self) -> dict[str, Any]:
        """What two runs must share for one to resume the other; how many trials there are may differ."""
        return {**self.job(0).identity(), "space": self.space.to_dict()}


@dataclass(frozen=True, slots=True)
class Tuned:
    """What came of it."""

    recipe: Recipe
    """The best of those that had all their updates."""
    records: tuple[Record, ...]
    """By trial."""
    path: Path
    """Of the recipe's file."""

    @property
    def chosen(self) -> Record:
        """Of the best."""
        return finished(self.records)[0]

    @property
    def untuned(self) -> Record:
        """Of the recipe as it is."""
        return self.records[0]


def tune(
    tuning: Tuning,
    folder: Path,
    report: Report,
    cluster: str = LOCAL,
    side_by_side: int | None = None,
    overwrite: bool = False,
) -> Tuned:
    """Run the trials, and write ``recipe.toml`` and ``trials.csv`` in ``folder``.

    ``report`` is called with all records whenever one says more. Whatever is known is kept in the folder when it is known, so that
    an interrupted call resumes by another of the same arguments; with more ``trials`` further ones are run. Trials are drawn and
    trained alike, bit for bit, however many run side by side; with one at a time the same are stopped, too.

    Raises ValueError for what the recipe, space and scenario cannot be, if the folder holds another tuning that is not to be
    overwritten, if the cluster does not answer, and if the recipe as it is fails.
    """
    checked("trials", tuning.trials, TRIALS)
    check_address(cluster)
    if cluster.startswith(CLIENT):
        raise Refused(
            "cluster", cluster, f"{LOCAL}, or HOST:PORT: from outside a cluster Ray Tune would keep what it finds to itself"
        )
    import_module("train.tuning.search")  # Ray Tune: where it is missing, that is said before anything is computed
    jobs = [held(tuning.job(trial)) for trial in range(tuning.trials)]
    jobs[0].tasks()
    with alone_in(folder), ending_as_interrupted():
        _begin(folder, tuning, overwrite)
        records = [known(folder, Record(trial, _settings(job, tuning.space))) for trial, job in enumerate(jobs)]
        records = _run(jobs, records, folder, report, cluster, side_by_side)
        if records[0].ended == FAILED:
            raise ValueError(f"recipe {tuning.name!r} fails as it is: {records[0].sentence}.")
        tuned = Tuned(jobs[finished(records)[0].trial].recipe, tuple(records), folder / RECIPE)
        write_csv(folder / TABLE, rows(records))
        write_whole(tuned.path, as_toml(tuned.recipe, told(tuning, tuned)))
    return tuned


def _begin(folder: Path, tuning: Tuning, overwrite: bool) -> None:
    """The folder's own file; ``ValueError`` if it is another tuning's."""
    path, identity = folder / ABOUT, tuning.identity()
    if overwrite:
        for each in (path, folder / RECIPE, folder / TABLE):
            each.unlink(missing_ok=True)
        shutil.rmtree(folder / "trials", ignore_errors=True)
    if path.is_file() and read_json(path) != identity:
        raise ValueError(f"folder = {str(folder)!r} holds another tuning: overwrite it, or name another folder.")
    write_json(path, identity)


def _settings(job: Job, space: Space) -> dict[str, Any]:
    return {name: value_of(job.recipe.settings, name) for name in space.tried}


def _run(
    jobs: Sequence[Job], records: list[Record], folder: Path, report: Report, cluster: str, side_by_side: int | None
) -> list[Record]:
    """The trials that have not ended."""
    now = list(records)

    def found(record: Record) -> None:
        now[record.trial] = record
        keep(folder, record)
        if record.ended:
            shutil.rmtree(checkpoints(folder, record.trial), ignore_errors=True)
        report(now)

    report(now)
    if all(record.ended for record in records):
        return records
    from train.tuning.search import Search, search

    return search(Search(jobs, records, rungs(jobs[0].recipe.updates), folder.absolute()), found, cluster, side_by_side)


def told(tuning: Tuning, tuned: Tuned) -> str:
    """What the recipe's file says of itself."""
    best, own = tuned.chosen.looks[-1], tuned.untuned.looks[-1]
    chosen = f"Chosen by beamenv tune: trial {tuned.chosen.trial} of {tuning.trials} of {tuning.name} on {tuning.scenario}"
    return (
        f"{on_one_line(chosen)}, seed {tuning.seed}.\n"
        f"J over no control on the {EPISODES} validation episodes that chose it, seeds from {VALIDATION} on: {best.cost:.4f}, "
        f"of the recipe as it was {own.cost:.4f}.\n"
        f"On the {EPISODES} validation episodes that follow, which chose nothing: {best.apart:.4f} and {own.apart:.4f}."
    )
