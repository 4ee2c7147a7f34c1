"""What ``beamenv reproduce`` does: run, show progress, write the page, sum up."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import typer
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn

from beamenv.configuration.writing import write_whole
from train.cli.bars import Bars
from train.cli.options import complain, note, print_json
from train.reproduce.catalogue import FUTURE_WORK, NAMES, STUDIES, THESIS_STUDIES, chosen
from train.reproduce.index import first_verdicts, second_verdicts
from train.reproduce.judging.ledger import ROWS, counts
from train.reproduce.judging.study import Study
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.overview import verdicts_of
from train.reproduce.report import documentation, html_page, markdown_page
from train.reproduce.runner import Record, load, pictures_in, run, source_fingerprint
from train.reproduce.section import OWN_WORDS
from train.reproduce.thesis import Model
from train.shared.files import check_folder
from train.shared.lock import alone_in
from train.workers.workers import Workers

THEIR_WORDS = {verdict: verdict.value for verdict in Verdict}


def reproduce(
    names: list[str],
    output: Path,
    fresh: bool = False,
    docs: Path | None = None,
    workers: Workers = Workers(),  # noqa: B008 - frozen
    as_json: bool = False,
) -> int:
    """Run the named studies (all for none), write the page, say or print as JSON what came out, and return the exit status.

    0: done; 1: a study failed. After an interruption the page of what is finished is written, and it is raised again.
    ``ValueError`` for an unknown name, a folder in which nothing can be written or another process is at work, a damaged record.
    """
    studies = chosen(names)
    if docs is not None:
        check_folder(docs, "docs")
    records: list[Record] = []
    with alone_in(output):
        for study in STUDIES:
            if not (fresh and study in studies):
                load(output, study.name)
        if not fresh:
            tell_kept(studies, output)
        try:
            run_with_progress(studies, output, fresh, records, workers)
        except KeyboardInterrupt:
            sum_up(output, records, docs, as_json)
            raise
        sum_up(output, records, docs, as_json)
        if names and not as_json:
            tell_statements(records)
    return int(any(record.error for record in records))


def tell_kept(studies: Sequence[Study], output: Path) -> None:
    """How many are kept from an earlier run, if any."""
    fingerprint = source_fingerprint(Model())
    if kept := sum(load(output, study.name, fingerprint) is not None for study in studies):
        complain(f"resumed: {kept} of {len(studies)} are kept from an earlier run.")


def run_with_progress(studies: tuple[Study, ...], output: Path, fresh: bool, records: list[Record], workers: Workers) -> None:
    """Run the studies under a progress bar, adding each record as it is finished."""
    with _Bar(len(studies)) as bar:

        def finished(record: Record) -> None:
            records.append(record)
            bar.show(record)

        run(studies, output, fresh=fresh, finished=finished, workers=workers)


class _Bar(Bars):
    """Studies that are finished, and the last of them."""

    def __init__(self, studies: int) -> None:
        super().__init__(TextColumn("{task.description:12}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        self._task = self._bars.add_task("", total=studies)

    def show(self, record: Record) -> None:
        self.update(self._task, advance=1, description=record.name)


def sum_up(output: Path, records: list[Record], docs: Path | None, as_json: bool = False) -> None:
    """The page, and in a few lines or as JSON what came out, in the thesis' order whichever was done first."""
    records = sorted(records, key=lambda record: NAMES.index(record.name))
    write_pages(output, records, docs)
    if as_json:
        print_json({"folder": str(output), "page": str(output / "report.html"), "studies": [content(each) for each in records]})
    else:
        report(records, output)


def content(record: Record) -> dict[str, Any]:
    """A study's verdicts as JSON, in nature and by the thesis' equations."""
    first, second = ({key: each.verdict.value for key, each in found.items()} for found in (record.judgements, record.second))
    return {"name": record.name, "in_nature": first, "by_equations": second, "error": record.error or None}


def write_pages(output: Path, records: list[Record], docs: Path | None) -> None:
    """The page of everything that is finished in ``output``, in this run or before."""
    shown = with_earlier(output, records)
    write_whole(output / "report.html", html_page(shown, output))
    write_whole(output / "report.md", markdown_page(shown))
    if docs is not None:
        for name, content in documentation(shown, "figures").items():
            write_whole(docs / name, content)
        for record in shown:
            if not record.error:
                for picture in pictures_in(output, record.name).values():
                    write_whole(docs / "figures" / picture.name, picture.read_bytes())


def with_earlier(output: Path, records: list[Record]) -> list[Record]:
    """The records of this run, and of earlier ones from the same sources."""
    known = {record.name: record for record in records}
    fingerprint = records[0].fingerprint if records else None
    earlier = [load(output, study.name, fingerprint) for study in STUDIES if study.name not in known]
    return [*records, *(record for record in earlier if record is not None)]


def report(records: list[Record], output: Path) -> None:
    """What came out, in a few lines."""
    everything = with_earlier(output, records)
    told("Statements", verdicts_of(THESIS_STUDIES, first_verdicts(records)))
    told("By the thesis' equations", verdicts_of(THESIS_STUDIES, second_verdicts(records)))
    told("Checks of the future work", verdicts_of(FUTURE_WORK[1], first_verdicts(records)), OWN_WORDS)
    rows = [row.verdict(first_verdicts(everything)) for row in ROWS if row.decided_by]
    if any(rows):
        told("Conclusions", [*rows, *(Verdict.UNTESTABLE for row in ROWS if not row.decided_by)])
    for record in records:
        if record.error:
            typer.echo(f"{record.name} failed: {record.error}", err=True)
    typer.echo(f"{output / 'report.html'}")


def tell_statements(records: Sequence[Record]) -> None:
    """What each study that was asked for judges, with its verdicts: in nature, and by the thesis' equations where they tell."""
    for record in records:
        study = next(each for each in STUDIES if each.name == record.name)
        words = THEIR_WORDS if study in THESIS_STUDIES else OWN_WORDS
        note(f"{study.name}: {study.title}")
        for each in study.statements:
            if each.key in record.judgements:
                second = record.second.get(each.key)
                again = "" if second is None else f"; by the thesis' equations {words[second.verdict]}"
                note(f"- {words[record.judgements[each.key].verdict]}{again}: {each.text}")


def told(what: str, verdicts: Sequence[Verdict | None], words: Mapping[Verdict, str] = THEIR_WORDS) -> None:
    """How many of each, if there are any."""
    if verdicts:
        typer.echo(f"{what}: " + ", ".join(f"{number} {words[verdict]}" for verdict, number in counts(verdicts).items()))
