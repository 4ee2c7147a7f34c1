"""The command ``beamenv benchmark``."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from beamenv.configuration.files import ENDINGS
from beamenv.scenarios.named import GROUPS
from train.cli.options import RESUMES, JsonOption, one_sentence, print_json, print_table
from train.shared.digests import digest
from train.shared.files import check_folder

if TYPE_CHECKING:
    from train.benchmark.table import BenchmarkTable, Row

SEEDS = 128

LONGEST = 60
"""Characters of a folder's name before a digest ends it."""


def benchmark(
    scenario: Annotated[
        list[str] | None,
        typer.Option(help=f"Name or TOML file of a scenario, or {', '.join(GROUPS)} of them; repeat for more. All if left out."),
    ] = None,
    controller: Annotated[
        list[str] | None, typer.Option(help="Name of a controller or shipped agent; repeat for more. All of them if left out.")
    ] = None,
    seeds: Annotated[int, typer.Option(min=2, help="How many held-out episodes.")] = SEEDS,
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
    trust: Annotated[bool, typer.Option("--trust", help="Load --model files: I know where they are from.")] = False,
    jobs: Annotated[int, typer.Option(min=1, help="Processes at work side by side.")] = 2,
    docs: Annotated[Path | None, typer.Option(help="Folder that gets benchmark.md and its heat map.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Every controller in every scenario on the same held-out episodes. At most ten minutes on two cores.

    An interrupted run resumes from what its folder holds; a folder with a benchmark of other settings is refused. What cannot be
    measured is reported in one sentence each, the rest is measured, and the status is then 1.
    """
    with one_sentence(RESUMES):
        if docs is not None:
            check_folder(docs, "docs")
        home = default_folder(scenario or (), controller or (), seeds, model or ()) if folder is None else folder
        table = _measured(
            scenarios=scenario or None,
            controllers=controller or None,
            seeds=seeds,
            folder=home,
            models=model or (),
            trusted=trust,
            jobs=jobs,
        )
        if docs is not None:
            from train.benchmark.showing.docs import write_docs

            write_docs(docs, table, shlex.join(["beamenv", *sys.argv[1:]]))
    _show(table, None if as_json else home)
    if table.sentences:
        raise typer.Exit(1)


def _measured(**arguments: Any) -> BenchmarkTable:
    """The benchmark, with its bar."""
    from train.benchmark.campaign import benchmark as run

    with _Bar() as bar:
        return run(**arguments, progress=bar.show)


def default_folder(scenarios: Sequence[str], controllers: Sequence[str], seeds: int, models: Sequence[Path]) -> Path:
    """``results/benchmark``, with what is chosen behind it: each choice has a folder of its own."""
    scenarios = () if list(scenarios) == ["all"] else scenarios
    chosen = [Path(name).stem if name.endswith(ENDINGS) else name for name in (*scenarios, *controllers)]
    chosen += [path.stem for path in models] + ([] if seeds == SEEDS else [str(seeds)])
    name = "-".join(["benchmark", *chosen])
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
        _print(table, folder)
    for where, sentence in table.sentences.items():
        print(f"beamenv: {where}: {sentence}", file=sys.stderr)  # noqa: T201 - the command's own voice


def _print(table: BenchmarkTable, folder: Path) -> None:
    """Two digits of each cell, never cut off however narrow the terminal is; the files hold the rest."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from train.benchmark.targets import findings

    caption = f"▲ some episodes unstable. Written to {folder}"
    shown = Table(title="J / J without control", caption=Text(caption), box=box.SIMPLE, padding=(0, 1, 0, 0))
    shown.add_column("controller", no_wrap=True)
    shown.add_column("tier", justify="right")
    tiers = {row.controller: str(row.tier) for row in table.rows}
    for name in table.scenarios:
        shown.add_column(Text(name), justify="right", no_wrap=True)
    for name in table.controllers:
        shown.add_row(Text(name), tiers[name], *(_brief(table.row(scenario, name)) for scenario in table.scenarios))
    print_table(shown)
    for each in findings(table):
        Console().print(each.sentence, highlight=False, markup=False)


def _brief(row: Row | None) -> str:
    from train.shared.columns import number

    if row is None or not row.measured:
        return "–" if row is None else "✕"
    value = row.estimates["relative_cost"].value
    return number(value, "{:.2f}" if value < 10.0 else "{:.0f}") + ("▲" if row.estimates["unstable"].value else "")
