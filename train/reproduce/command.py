"""The command ``beamenv reproduce``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from train.reproduce.catalogue import chosen
from train.reproduce.ledger import ROWS, counts
from train.reproduce.report import html_page, markdown_page
from train.reproduce.runner import Record, load, run, write
from train.reproduce.study import Study
from train.reproduce.verdicts import Verdict


def reproduce(
    names: Annotated[list[str] | None, typer.Argument(help="Tables and figures, say table-3.4 figure-5.7; all if none.")] = None,
    output: Annotated[Path, typer.Option(help="Folder for a CSV and a PNG of each, and the page.")] = Path("results/thesis"),
    fresh: Annotated[bool, typer.Option(help="Do again what is finished already.")] = False,
    docs: Annotated[Path | None, typer.Option(help="Folder that gets the page too, as thesis.md with figures/.")] = None,
) -> None:
    """Regenerate the thesis' tables and figures and judge its statements."""
    try:
        studies = chosen(names or [])
    except ValueError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(2) from None
    interrupted = False
    records: list[Record] = []
    try:
        run_with_progress(studies, output, fresh, records)
    except KeyboardInterrupt:
        interrupted = True
    write_pages(output, records, docs)
    report(records, output)
    if interrupted:
        typer.echo("Interrupted: the same command goes on from here.", err=True)
        raise typer.Exit(130)
    if any(record.error for record in records):
        raise typer.Exit(1)


def run_with_progress(studies: tuple[Study, ...], output: Path, fresh: bool, records: list[Record]) -> None:
    """Run the studies under a progress bar, adding each record as it is finished."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    with Progress(TextColumn("{task.description:12}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn()) as progress:
        task = progress.add_task(studies[0].name, total=len(studies))
        following = iter([*(study.name for study in studies[1:]), "finished"])

        def finished(record: Record) -> None:
            records.append(record)
            progress.update(task, advance=1, description=next(following))

        run(studies, output, fresh=fresh, finished=finished)


def write_pages(output: Path, records: list[Record], docs: Path | None) -> None:
    """The page of everything that is finished in ``output``, in this run or before."""
    shown = with_earlier(output, records)
    write(output / "report.html", html_page(shown, output).encode())
    write(output / "report.md", markdown_page(shown).encode())
    if docs is not None:
        write(docs / "thesis.md", markdown_page(shown, "figures").encode())
        for record in shown:
            if not record.error:
                write(docs / "figures" / f"{record.name}.png", (output / f"{record.name}.png").read_bytes())


def with_earlier(output: Path, records: list[Record]) -> list[Record]:
    """The records of this run, and of earlier ones from the same sources."""
    known = {record.name: record for record in records}
    fingerprint = records[0].fingerprint if records else None
    earlier = [load(output, study.name, fingerprint) for study in chosen([]) if study.name not in known]
    return [*records, *(record for record in earlier if record is not None)]


def report(records: list[Record], output: Path) -> None:
    """What came out, in a few lines."""
    by_name = {study.name: study for study in chosen([])}
    verdicts = counts(
        [verdict for record in records if not record.error for verdict in by_name[record.name].verdicts(record.judgements)]
    )
    typer.echo("Statements: " + ", ".join(f"{number} {verdict.value}" for verdict, number in verdicts.items()))
    judgements = {record.name: record.judgements for record in with_earlier(output, records) if not record.error}
    rows = counts([row.verdict(judgements) for row in ROWS])
    if sum(rows.values()) > rows[Verdict.UNTESTABLE]:
        typer.echo("Conclusions: " + ", ".join(f"{number} {verdict.value}" for verdict, number in rows.items()))
    for record in records:
        if record.error:
            typer.echo(f"{record.name} failed: {record.error}", err=True)
    typer.echo(f"{output / 'report.html'}")
