"""The command ``beamenv benchmark``."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.progress import BarColumn, MofNCompleteColumn, TaskID, TextColumn, TimeRemainingColumn

from beamenv.configuration.files import ENDINGS, content_of
from train.cli.bars import Bars
from train.cli.benchmark_options import (
    SEEDS,
    ControllersOption,
    DocsOption,
    EpisodesOption,
    FolderOption,
    ModelsOption,
    QuickOption,
    RunsOption,
    ScenariosOption,
    SubmitOption,
    TierOption,
    TrustOption,
)
from train.cli.benchmark_table import finite_row, show_benchmark, show_entry
from train.cli.names import check_controller, check_names, check_scenarios
from train.cli.options import (
    RESUMES,
    ClusterOption,
    JobsOption,
    JsonOption,
    PlantOption,
    complain,
    one_sentence,
    overwriting,
    print_json,
    say,
    working,
)
from train.cli.quick import QUICK_RUNS, QUICK_SCENARIOS, QUICK_SEEDS, quick_controllers, wide
from train.shared.digests import digest
from train.shared.files import check_folder

if TYPE_CHECKING:
    from train.benchmark.table import BenchmarkTable

LONGEST = 60
"""Characters of a folder's name before a digest ends it."""


def benchmark(
    scenario: ScenariosOption = None,
    controller: ControllersOption = None,
    episodes: EpisodesOption = None,
    runs: RunsOption = None,
    folder: FolderOption = None,
    model: ModelsOption = None,
    trust: TrustOption = False,
    quick: QuickOption = False,
    submit: SubmitOption = None,
    tier: TierOption = None,
    overwrite: Annotated[bool, overwriting("another entry of the same name")] = False,
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    plant: PlantOption = None,
    docs: DocsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Run every controller in every scenario on the same held-out episodes; with --quick a few, with --submit one of yours.

    An interrupted run resumes from what its folder holds; a folder with a benchmark of other settings is refused. If something
    cannot be measured, one sentence says why, the rest is measured, and the exit status is 1. Controllers and scenarios that a
    --plant does not allow are left out, each with the reason; if you name one of them, it is refused.
    """
    with one_sentence(RESUMES):
        check_all(scenario or (), controller or (), (model or ()) if trust else (), submit, plant)
        workers, asked = working(jobs, cluster), Asked(scenario, controller, episodes, runs, model, quick, plant)
        how = {"trusted": trust, "jobs": workers.jobs, "cluster": cluster}
        if submit is not None:
            entered(submit, asked, folder, docs, as_json, tier=tier, overwrite=overwrite, **how)
            return
        check_no_entry(tier=tier, overwrite=overwrite or None)
        if docs is not None:
            check_folder(docs, "docs")
        home = asked.usual_folder if folder is None else folder
        table = _measured(**asked.arguments, folder=home, **how)
        if docs is not None:
            from train.benchmark.showing.docs import write_docs

            write_docs(docs, table, shlex.join(["beamenv", *sys.argv[1:]]))
    _show(table, None if as_json else home, quick)
    if table.sentences:
        raise typer.Exit(1)


def check_all(
    scenarios: Sequence[str], controllers: Sequence[str], models: Sequence[Path], submit: str | None, plant: Path | None
) -> None:
    """``ValueError`` of one sentence for a name that there is not, and for a file that is not there."""
    check_scenarios(scenarios)
    for each in controllers:
        check_controller(each)
    for path in models:
        content_of(path, 1)
    if submit is not None and not submit.lower().endswith(".zip"):
        check_controller(submit, "submit", "the folder of a trained agent, a model's .zip file")
    check_names(plant=plant)


@dataclass(frozen=True, slots=True)
class Asked:
    """What is to be measured, as far as options say."""

    scenario: list[str] | None
    controller: list[str] | None
    episodes: int | None
    runs: int | None
    model: list[Path] | None
    quick: bool
    plant: Path | None

    @property
    def given(self) -> list[str]:
        """The names of the options that say something."""
        return [f"--{name}" for name in self.__dataclass_fields__ if getattr(self, name)]

    @property
    def seeds(self) -> int:
        """How many they are."""
        return self.episodes or (QUICK_SEEDS if self.quick else SEEDS)

    @property
    def usual_folder(self) -> Path:
        """Where it is written unless said otherwise."""
        models = self.model or ([] if self.plant is None else [self.plant])
        chosen = self.scenario or (), self.controller or (), self.seeds, models
        return default_folder(*chosen, quick=self.quick, runs=self.runs)

    @property
    def arguments(self) -> dict[str, Any]:
        """Those of the benchmark; what else is given comes before what is quick."""
        return {
            "scenarios": self.scenario or (QUICK_SCENARIOS if self.quick else None),
            "controllers": self.controller or (quick_controllers(self.plant) if self.quick else None),
            "seeds": self.seeds,
            "runs": self.runs or (QUICK_RUNS if self.quick else None),
            "models": self.model or (),
            "environment": {} if self.plant is None else {"plant": str(self.plant)},
        }


def check_no_entry(**options: int | bool | None) -> None:
    """``ValueError`` for options of an entry where none is made."""
    for name, given in options.items():
        if given is not None:
            raise ValueError(f"--{name} is of an entry on the leaderboard: name that with --submit.")


def entered(submit: str, asked: Asked, folder: Path | None, docs: Path | None, as_json: bool, **arguments: Any) -> None:
    """Run an entry, append it to the leaderboard, and say where it stands."""
    from train.benchmark.submission import submit as run

    if others := asked.given:
        raise ValueError(f"submit = {submit!r} runs what every entry is put through, so leave out {' and '.join(others)}.")
    board = Path("results") if docs is None else docs
    home = default_folder((), ("submit", submit), SEEDS, ()) if folder is None else folder
    with _Bar() as bar:
        entry, table = run(submit, board, folder=home, progress=bar.show, recording=bar.record, **arguments)
        bar.end()
    if as_json:
        print_json(finite_row(entry))
    else:
        show_entry(entry, table, board, home)


def _measured(**arguments: Any) -> BenchmarkTable:
    """The benchmark, with its bar."""
    from train.benchmark.campaign import benchmark as run

    with _Bar() as bar:
        table = run(**arguments, progress=bar.show, recording=bar.record)
        bar.end()
    return table


def default_folder(
    scenarios: Sequence[str],
    controllers: Sequence[str],
    seeds: int,
    models: Sequence[Path],
    *,
    quick: bool = False,
    runs: int | None = None,
) -> Path:
    """``results/benchmark``, with what is chosen behind it: each choice has a folder of its own."""
    scenarios = () if list(scenarios) == ["all"] and not quick else scenarios
    usual = QUICK_SEEDS if quick else SEEDS
    chosen = [Path(name).stem if name.endswith(ENDINGS) else name for name in (*scenarios, *controllers)]
    chosen += [path.stem for path in models] + ([] if seeds == usual else [str(seeds)]) + ([] if runs is None else [f"{runs}-runs"])
    name = "-".join(["benchmark", *(["quick"] if quick else []), *chosen])
    short = name if len(name) <= LONGEST else f"{name[:LONGEST]}-{digest(name.encode())}"
    return Path("results", "".join(letter if letter.isalnum() or letter in "-_. " else "_" for letter in short))


class _Bar(Bars):
    """Cells done."""

    def __init__(self) -> None:
        name = TextColumn("{task.description:>44}", markup=False)
        super().__init__(name, BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        self._task = self._bars.add_task("building the blades", total=None)
        self._begun = False
        self._page: TaskID | None = None

    def show(self, done: int, total: int, cell: object) -> None:
        if not self._begun and done > 1:
            self.say(f"resumed: {done - 1} of {total} cells are kept from an earlier run.")
        self._begun = True
        name = " ".join(getattr(cell, part) for part in ("scenario", "controller", "run"))
        self.update(self._task, description=name.strip(), completed=done, total=total)

    def record(self, done: int, total: int, name: str) -> None:
        if self._page is None:
            self._page = self._bars.add_task("", total=total)
        self.update(self._page, description=f"report.html: recording {name}", completed=done)

    def end(self) -> None:
        """Where no cell was left to be measured, say so."""
        if not self._begun:
            self.say("resumed: all cells are kept from an earlier run.")


def _show(table: BenchmarkTable, folder: Path | None, quick: bool) -> None:
    """For people, who are told the folder, or as JSON; and what could not be measured."""
    from train.benchmark.showing.report import as_json

    if folder is None:
        print_json(as_json(table))
    else:
        show_benchmark(table, folder)
    for sentence in table.left_out:
        complain(sentence)
    for where, sentence in table.sentences.items():
        complain(f"{where}: {sentence}")
    if quick and folder is not None:
        say(wide(table))
