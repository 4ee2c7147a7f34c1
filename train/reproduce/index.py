"""The list of everything that is judged: tables and figures, their statements, and what the thesis concludes."""

from __future__ import annotations

from collections.abc import Sequence

from train.reproduce import catalogue
from train.reproduce.judging.ledger import ROWS, Judgements, Row
from train.reproduce.judging.study import Study, called
from train.reproduce.judging.stumbling import STUMBLING
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.markup import Cell, Link, Markup, Text
from train.reproduce.runner import Record
from train.reproduce.section import BY_EQUATIONS, IN_NATURE, shown_own, shown_second, shown_verdict

Known = dict[str, Record]
"""Records of what was run, by name."""


def first_verdicts(records: Sequence[Record]) -> Judgements:
    """In nature, by study and key."""
    return {record.name: record.judgements for record in records if not record.error}


def second_verdicts(records: Sequence[Record]) -> Judgements:
    """By the thesis' equations, likewise."""
    return {record.name: record.second for record in records if not record.error}


def index(records: Sequence[Record], markup: Markup) -> list[str]:
    """Chapter by chapter what was run."""
    known = {record.name: record for record in records if not record.error}
    parts = [markup.heading(2, "All tables, figures and statements", "")]
    for chapter in catalogue.CHAPTERS:
        title, studies = chapter
        shown = [study for study in studies if study.name in known]
        if shown:
            parts += [markup.heading(3, title, ""), markup.paragraph("With figures and numbers: ", Link(title, title), ".")]
            parts += own_items(shown, known, markup) if chapter == catalogue.FUTURE_WORK else items(shown, known, markup)
    return parts


def items(studies: Sequence[Study], known: Known, markup: Markup) -> list[str]:
    """Tables and figures with both verdicts, and folded their statements."""
    rows: list[list[Cell]] = []
    for study in studies:
        first, second = known[study.name].judgements, known[study.name].second
        held = " / ".join(str(study.verdicts(each).count(Verdict.REPRODUCED)) for each in (first, second))
        verdicts = shown_verdict(study.verdict(first)), shown_second(study.verdict(second))
        rows.append([link(study), study.title, *verdicts, f"{held} of {len(study.own_statements)}"])
    said: list[list[Cell]] = [
        [link(study), each.text, shown_verdict(found.judgements[each.key].verdict), shown_second(found.second[each.key].verdict)]
        for study, found in ((study, known[study.name]) for study in studies)
        for each in study.own_statements
    ]
    return [
        markup.table(["item", "what it shows", IN_NATURE, BY_EQUATIONS, "statements that hold, of both"], rows),
        markup.folded(f"All {len(said)} statements", markup.table(["item", "statement", IN_NATURE, BY_EQUATIONS], said)),
    ]


def own_items(studies: Sequence[Study], known: Known, markup: Markup) -> list[str]:
    """Our own work, which has one verdict."""
    rows: list[list[Cell]] = []
    for study in studies:
        verdicts = study.verdicts(known[study.name].judgements)
        held = f"{verdicts.count(Verdict.REPRODUCED)} of {len(verdicts)}"
        rows.append([link(study), study.title, shown_own(study.verdict(known[study.name].judgements)), held])
    return [markup.table(["item", "what it shows", "check", "statements that hold"], rows)]


def link(study: Study) -> Link:
    """To where it is shown."""
    return Link(called(study.name), study.name)


def stumbling(records: Sequence[Record], markup: Markup) -> list[str]:
    """What a reader who compares with the thesis stumbles over first, and why."""
    first, second = first_verdicts(records), second_verdicts(records)
    rows = [[decided_by(row, first), *stated(row, first, second)] for row in STUMBLING]
    table = markup.table(["where", "statement", IN_NATURE, BY_EQUATIONS, "why"], rows)
    return [markup.heading(2, "Where a reader of the thesis stumbles", ""), table]


def conclusions(records: Sequence[Record], markup: Markup) -> list[str]:
    """The concluding statements."""
    first, second = first_verdicts(records), second_verdicts(records)
    rows = [[row.section, *stated(row, first, second), decided_by(row, first) or "nothing"] for row in ROWS]
    table = markup.table(["section", "statement", IN_NATURE, BY_EQUATIONS, "why", "decided by"], rows)
    return [markup.heading(3, "Concluding statements", ""), table]


def stated(row: Row, first: Judgements, second: Judgements) -> tuple[Cell, ...]:
    """A statement with both verdicts, and why."""
    verdict, again = row.verdict(first), row.verdict(second)
    shown = shown_verdict(verdict) if verdict else "not run", shown_second(again) if again else "not run"
    return (row.text, *shown, row.remark)


def decided_by(row: Row, known: Judgements) -> tuple[Text, ...]:
    """The tables and figures that decide it, as links to those that were run."""
    names = dict.fromkeys(study for study, _ in row.decided_by)
    return tuple(Link(called(name), name) if name in known else called(name) for name in names)
