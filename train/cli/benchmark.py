"""The command ``beamenv benchmark``."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from beamenv.configuration.files import ENDINGS
from beamenv.scenarios.named import GROUPS
from train.cli.benchmark_table import finite_row, show_entry, show_table
from train.cli.options import (
    RESUMES,
    ClusterOption,
    JobsOption,
    JsonOption,
    PlantOption,
    one_sentence,
    print_json,
    working,
)
from train.cli.quick import QUICK_RUNS, QUICK_SCENARIOS, QUICK_SEEDS, quick_controllers, told, wide
from train.shared.digests import digest
from train.shared.files import check_folder

if TYPE_CHECKING:
    from train.benchmark.table import BenchmarkTable

SEEDS = 128

LONGEST = 60
"""Characters of a folder's name before a digest ends it."""


def benchmark(
    scenario: Annotated[
        list[str] | None,
        typer.Option(help=f"Name or TOML file of a scenario, or {', '.join(GROUPS)} of them; repeat for more. All if left out."),
    ] = None,
    controller: Annotated[
        list[str] | None,
        typer.Option(
            help="Name of a controller or shipped agent, or a trained one's folder; repeat for more. All with a name if left out."
        ),
    ] = None,
    seeds: Annotated[int | None, typer.Option(min=2, help=f"How many held-out episodes; {SEEDS} if left out.")] = None,
    runs: Annotated[
        int | None, typer.Option(min=1, help="How many training runs of each agent, the first ones; all of them if left out.")
    ] = None,
    folder: Annotated[
        Path | None,
        typer.Option(
            help="Where cells, tables, heat map and page are written; results/benchmark, or …-WHAT IS CHOSEN, if left out."
        ),
    ] = None,
    model: Annotated[
        list[Path] | None,
        typer.Option(help="Stable-Baselines3 model to take part. Such a file can run code when it is loaded: see --trust."),
    ] = None,
    trust: Annotated[bool, typer.Option("--trust", help="Load model files: I know where they are from.")] = False,
    quick: Annotated[
        bool, typer.Option("--quick", help=f"Less than a minute on two cores: {told()}. What else is given comes first.")
    ] = False,
    submit: Annotated[
        str | None,
        typer.Option(
            help="Enter a trained agent's folder, a model's .zip or a controller by name on the leaderboard, once it has been run "
            "in every scenario."
        ),
    ] = None,
    tier: Annotated[int | None, typer.Option(help="Of the entry: 0, 1 or 2; what it says of itself, or 1, if left out.")] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace another entry of the same name.")] = False,
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    plant: PlantOption = None,
    docs: Annotated[
        Path | None,
        typer.Option(help="Folder that gets benchmark.md and its heat map; with --submit that of the leaderboard, else results."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Every controller in every scenario on the same held-out episodes; with --quick a few, with --submit one of yours.

    An interrupted run resumes from what its folder holds; a folder with a benchmark of other settings is refused. What cannot be
    measured is reported in one sentence each, the rest is measured, and the status is then 1. What cannot be had of a --plant is
    left out with its reason, which is no failure; asked for by name, it is refused.
    """
    with one_sentence(RESUMES):
        workers = working(jobs, cluster)
        chosen = {
            "scenario": scenario,
            "controller": controller,
            "seeds": seeds,
            "runs": runs,
            "model": model,
            "quick": quick,
            "plant": plant,
        }
        if submit is not None:
            how = {"trusted": trust, "overwrite": overwrite, "jobs": workers.jobs, "cluster": cluster}
            entered(submit, chosen, folder, docs, as_json, tier=tier, **how)
            return
        for name, given in {"tier": tier, "overwrite": overwrite or None}.items():
            if given is not None:
                raise ValueError(f"{name} = {given} is of an entry on the leaderboard: name that with --submit.")
        if docs is not None:
            check_folder(docs, "docs")
        episodes = seeds or (QUICK_SEEDS if quick else SEEDS)
        those = model or ([] if plant is None else [plant])
        usual = default_folder(scenario or (), controller or (), episodes, those, quick=quick, runs=runs)
        home = usual if folder is None else folder
        table = _measured(
            scenarios=scenario or (QUICK_SCENARIOS if quick else None),
            controllers=controller or (quick_controllers(plant) if quick else None),
            seeds=episodes,
            runs=runs or (QUICK_RUNS if quick else None),
            folder=home,
            models=model or (),
            trusted=trust,
            jobs=workers.jobs,
            cluster=cluster,
            environment={} if plant is None else {"plant": str(plant)},
        )
        if docs is not None:
            from train.benchmark.showing.docs import write_docs

            write_docs(docs, table, shlex.join(["beamenv", *sys.argv[1:]]))
    _show(table, None if as_json else home)
    if quick and not as_json:
        Console().print(wide(table), highlight=False, markup=False)
    if table.sentences:
        raise typer.Exit(1)


def entered(
    submit: str, chosen: Mapping[str, Any], folder: Path | None, docs: Path | None, as_json: bool, **arguments: Any
) -> None:
    """Run an entry, append it to the leaderboard, and say where it stands."""
    from train.benchmark.submission import submit as run

    if others := [name for name, given in chosen.items() if given]:
        raise ValueError(f"submit = {submit!r} runs what every entry is put through, so leave out {' and '.join(others)}.")
    board = Path("results") if docs is None else docs
    home = default_folder((), ("submit", submit), SEEDS, ()) if folder is None else folder
    with _Bar() as bar:
        entry, table = run(submit, board, folder=home, progress=bar.show, **arguments)
    if as_json:
        print_json(finite_row(entry))
    else:
        show_entry(entry, table, board, home)


def _measured(**arguments: Any) -> BenchmarkTable:
    """The benchmark, with its bar."""
    from train.benchmark.campaign import benchmark as run

    with _Bar() as bar:
        return run(**arguments, progress=bar.show)


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


class _Bar:
    """Cells done, on standard error."""

    def __init__(self) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (TextColumn("{task.description:>44}", markup=False), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        self._bars = Progress(*columns, console=Console(stderr=True))
        self._task = self._bars.add_task("building the blades", total=None)

    def __enter__(self) -> _Bar:
        if self._bars.console.is_terminal:  # elsewhere bad input is to leave its one line alone
            self._bars.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if self._bars.live.is_started:
            self._bars.stop()

    def show(self, done: int, total: int, cell: object) -> None:
        self._bars.start()
        name = " ".join(getattr(cell, part) for part in ("scenario", "controller", "run"))
        self._bars.update(self._task, description=name.strip(), completed=done, total=total)


def _show(table: BenchmarkTable, folder: Path | None) -> None:
    """For people, who are told the folder, or as JSON; and what could not be measured."""
    from train.benchmark.showing.report import as_json

    if folder is None:
        print_json(as_json(table))
    else:
        show_table(table, folder)
    for sentence in table.left_out:
        print(f"beamenv: {sentence}", file=sys.stderr)  # noqa: T201 - the command's own voice
    for where, sentence in table.sentences.items():
        print(f"beamenv: {where}: {sentence}", file=sys.stderr)  # noqa: T201 - the command's own voice
