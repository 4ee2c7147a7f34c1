"""Running studies: each is computed, drawn and written whole before the next; what is there already is not done again."""

from __future__ import annotations

import csv
import io
import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from beamenv.configuration.writing import write_whole
from train.figures.paper import THEMES, dark
from train.reproduce.drawing import curve_rows, draw
from train.reproduce.judging.second import Results, Second, judged_again
from train.reproduce.judging.study import Outcome, Part, Study
from train.reproduce.judging.verdicts import Judgement, Verdict
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import Reading
from train.shared.digests import digest, source_digest
from train.shared.files import read_json
from train.workers.workers import Workers

DEPENDS_ON = ("beamenv", "baselines", "train.reproduce", "train.figures.figure", "train.figures.paper")
"""Packages that decide what a study finds and shows."""


@dataclass(frozen=True, slots=True)
class Record:
    """What is kept of a study: enough for the page, beside its CSV and PNGs."""

    name: str
    seconds: float
    """Its parts' not included."""
    judgements: dict[str, Judgement]
    second: dict[str, Second] = field(default_factory=dict)
    """By the thesis' own equations."""
    notes: tuple[str, ...] = ()
    header: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    """The numbers of a table; a figure's are in its CSV only."""
    error: str = ""
    """Why the study failed, if it did."""
    fingerprint: str = ""


def run(
    studies: Sequence[Study],
    folder: Path,
    model: Model | None = None,
    fresh: bool = False,
    finished: Callable[[Record], None] = lambda record: None,
    workers: Workers = Workers(),  # noqa: B008 - frozen
) -> list[Record]:
    """Run studies into ``folder`` and return their records in the same order, calling ``finished`` as each is done.

    A study whose record is there, made by the same sources from the same model, is not run again unless ``fresh``. One that fails
    is recorded with its error and does not stop the others.
    """
    model = model or Model()
    folder.mkdir(parents=True, exist_ok=True)
    fingerprint = source_fingerprint(model)
    records: dict[str, Record] = {}

    def done(record: Record) -> None:
        records[record.name] = record
        finished(record)

    missing = []
    for study in studies:
        if not fresh and (kept := load(folder, study.name, fingerprint)):
            done(kept)
        else:
            missing.append(study)
    waiting = Waiting(missing, model, fingerprint)

    def came(piece: Piece, result: Any) -> Piece | None:
        if isinstance(result, Made):
            write(folder, result)
            done(result.record)
        else:
            waiting.found[piece.part] = result
        return waiting.ready()

    pieces = waiting.pieces()
    workers.at_most(len(pieces)).do(attempted, pieces, came)
    return [records[study.name] for study in studies]


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A part that can be found, or a study that can be made, by one worker."""

    part: Part
    arguments: tuple[Any, ...]
    """The part's, with what parts among them came to."""


class Waiting:
    """Studies that are to be made, each when all its parts are found."""

    def __init__(self, studies: Sequence[Study], model: Model, fingerprint: str) -> None:
        self.found: dict[Part, Any] = {}
        """What parts came to, exceptions included."""
        self._studies = [(study, study.parts_by_reading(model)) for study in studies]
        self._given = model, fingerprint
        self._parts = list(with_theirs(part for _, parts in self._studies for part in parts.values()))

    def pieces(self) -> list[Piece]:
        """What can begin at once: parts, every one once, then studies that have none.

        Parts take longer and studies wait for them; what takes a moment comes last, so that all workers end together.
        """
        begun = [part for part in self._parts if not part.parts]
        self._parts = [part for part in self._parts if part.parts]
        whole = [study for study, parts in self._studies if not parts]
        return [*(Piece(part, part.arguments) for part in begun), *(self._made(study, {}) for study in whole)]

    def ready(self) -> Piece | None:
        """The next study, or part, that has parts all of which are found."""
        for at, (study, parts) in enumerate(self._studies):
            if parts and self._are_found(parts.values()):
                del self._studies[at]
                return self._made(study, parts)
        for at, part in enumerate(self._parts):
            if self._are_found(part.parts):
                del self._parts[at]
                return Piece(part, tuple(self.found[each] if isinstance(each, Part) else each for each in part.arguments))
        return None

    def _are_found(self, parts: Iterable[Part]) -> bool:
        return all(part in self.found for part in parts)

    def _made(self, study: Study, parts: Mapping[tuple[Reading, Any], Part]) -> Piece:
        made = Part(made_of, (study, *self._given, {key: self.found[part] for key, part in parts.items()}))
        return Piece(made, made.arguments)


def with_theirs(parts: Iterable[Part]) -> dict[Part, None]:
    """Parts and the parts of these, each once, those that others need before them."""
    needed: dict[Part, None] = {}
    for part in parts:
        needed |= with_theirs(part.parts) | {part: None}
    return needed


def attempted(piece: Piece) -> Any:
    """Its result, or the exception that it or a part of it raised: whatever fails in one study must not stop the others."""
    try:
        check(piece.arguments)
        return piece.part.function(*piece.arguments)
    except Exception as error:  # noqa: BLE001
        return error


def check(found: Iterable[Any]) -> None:
    """Raise what has failed."""
    for failure in (each for each in found if isinstance(each, Exception)):
        raise failure


@dataclass(frozen=True, slots=True)
class Made:
    """What a study comes to, on whichever machine."""

    record: Record
    csv: str = ""
    pictures: Mapping[str, bytes] = field(default_factory=dict)
    """For light and for dark pages."""


def made_of(study: Study, model: Model, fingerprint: str, results: Results) -> Made:
    """Compute, judge twice and draw one study from what its parts came to."""
    start = time.perf_counter()
    try:
        own = {key: result for (reading, key), result in results.items() if not reading}
        check(own.values())
        outcome = study.compute(model, own)
        judgements = study.judge(outcome)
        second = judged_again(study, model, judgements, results)
        pictures = {theme: draw(outcome, study.heading, theme) for theme in THEMES}
    except Exception as error:  # noqa: BLE001 - as above
        seconds, told = time.perf_counter() - start, f"{type(error).__name__}: {error}"
        return Made(Record(study.name, seconds, {}, error=told, fingerprint=fingerprint))
    record = Record(
        name=study.name,
        seconds=time.perf_counter() - start,
        judgements=judgements,
        second=second,
        notes=tuple(outcome.notes),
        header=tuple(outcome.header) if study.tabulated else (),
        rows=tuple(tuple(map(shown, row)) for row in outcome.rows) if study.tabulated else (),
        fingerprint=fingerprint,
    )
    return Made(record, csv_text(outcome), pictures)


def write(folder: Path, made: Made) -> None:
    """The files of a study that has not failed, the record last: with it they are whole."""
    if made.record.error:
        return
    path = folder / made.record.name
    write_whole(path.with_name(f"{path.name}.csv"), made.csv)
    for theme, picture in pictures_in(folder, made.record.name).items():
        write_whole(picture, made.pictures[theme])
    write_whole(path.with_name(f"{path.name}.json"), json.dumps(asdict(made.record), ensure_ascii=False, indent=1))


def pictures_in(folder: Path, name: str) -> dict[str, Path]:
    """Where the pictures of a study lie, by their themes."""
    light = folder / f"{name}.png"
    return {"light": light, "dark": dark(light)}


def load(folder: Path, name: str, fingerprint: str | None = None) -> Record | None:
    """The record of a finished study, if it and its files are there and, when a fingerprint is given, up to date.

    Raises ValueError that names the file if it is none, or a damaged one.
    """
    path = folder / f"{name}.json"
    if not all(each.is_file() for each in (path, folder / f"{name}.csv", *pictures_in(folder, name).values())):
        return None
    kept = read_json(path)
    try:
        if fingerprint is not None and kept["fingerprint"] != fingerprint:
            return None
        judged = {key: Judgement(**with_verdict(value)) for key, value in kept["judgements"].items()}
        second = {key: second_of(value) for key, value in kept["second"].items()}
        record = Record(**(kept | {"judgements": judged, "second": second}))
        rows = tuple(tuple(row) for row in record.rows)
        return replace(record, notes=tuple(record.notes), header=tuple(record.header), rows=rows)
    except (KeyError, TypeError, ValueError, AttributeError):
        raise ValueError(f"file {str(path)!r} must hold the record of a study: remove it, and the study is run again.") from None


def with_verdict(kept: dict[str, Any]) -> dict[str, Any]:
    """The fields of a judgement as they were before they were written."""
    return kept | {"verdict": Verdict(kept["verdict"])}


def second_of(kept: dict[str, Any]) -> Second:
    """A second judgement likewise."""
    return Second(**(with_verdict(kept) | {name: tuple(kept[name]) for name in ("reading", "enough", "told")}))


def source_fingerprint(model: Model) -> str:
    """A digest of the sources and data that results depend on, and of the model."""
    return digest(repr(model).encode(), source_digest(DEPENDS_ON).encode())


def shown(cell: object) -> str:
    """A cell on the page: floats to seven digits, of which the CSV has all."""
    return f"{cell:.7g}" if isinstance(cell, float) else str(cell)


def csv_text(outcome: Outcome) -> str:
    """A table's own rows, then every point of every curve where there are no rows of its own."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    header, rows = (outcome.header, outcome.rows) if outcome.rows else curve_rows(outcome)
    writer.writerow(header)
    writer.writerows(rows)
    return buffer.getvalue()
