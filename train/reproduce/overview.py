"""What the page opens with: how it judges, how many of each verdict, why so many are negative, the concluding statements."""

from __future__ import annotations

from collections.abc import Sequence

from train.reproduce import catalogue
from train.reproduce.judging.ledger import ROWS, Judgements, Row, counts
from train.reproduce.judging.study import Study
from train.reproduce.judging.stumbling import STUMBLING
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.markup import Markup
from train.reproduce.runner import Record
from train.reproduce.section import BY_EQUATIONS, IN_NATURE, shown_second, shown_verdict
from train.reproduce.thesis.equations import EQUATIONS

INTRODUCTION = (
    "D. N. Vadiraja, Vibration Analysis, Control and Optimal Placement of MFC Actuators and Sensors on Rotating Thin-Walled "
    "Composite Cantilever Beams, IIT Guwahati, 2008. Made by `beamenv reproduce`. Every verdict is computed from the numbers "
    "beside it by "
    "the rule stated with it; a table or figure, and a concluding statement, takes the weakest verdict of the statements that "
    "decide it. "
    "Questions of our own stand beside them and decide nothing. Step loads are 30 N/m, so that ±1500 V matters; the thesis prints "
    "no load for "
    "its figures. Where the thesis leaves a configuration open or misprints it, the one used is named."
)
TWO_COLUMNS = (
    "Every statement is judged twice. “In nature” asks whether it is so: of the thesis' model, derived again from its energies, "
    "with the shear flow that a closed cell asks for, and checked against what others measured and computed (what that model "
    "still leaves out of nature is listed in the errata). “By the thesis' equations” asks whether the thesis computed it "
    "rightly from what it prints: the same computation with the equations of the table below in place of ours, all of those "
    "that bear on a figure together; chapter 6, whose weights are not printed, by the layouts that it prints. Where a statement "
    "then holds better than in nature, the equation is named that does it alone, the first in the table's order, or those that "
    "are needed together. What the thesis itself refutes, by its text, tables or equations, is tried last, told, and counts for "
    "nothing."
)
FUTURE_WORK_INTRODUCTION = (
    "What the thesis' section 7.2 left to others, and is there now (in words: docs/beyond-the-thesis.md). Nothing of the thesis is "
    "reproduced here: the statements are ours, written with the numbers at hand, and are counted apart. Where a closed form, a "
    "published number or an independent computation is named, one that holds is a validation; a limit or an order of our own that "
    "holds is a regression check: the code still gives what it gave when we looked."
)


def opening(records: Sequence[Record], markup: Markup) -> list[str]:
    """All that comes before the chapters."""
    return [
        markup.paragraph(INTRODUCTION),
        *overview(records, markup),
        markup.paragraph(TWO_COLUMNS),
        markup.paragraph(why(records)),
        equations(markup),
        *stumbling(records, markup),
        *ledger(records, markup),
    ]


def first_verdicts(records: Sequence[Record]) -> Judgements:
    """In nature, by study and key."""
    return {record.name: record.judgements for record in records if not record.error}


def second_verdicts(records: Sequence[Record]) -> Judgements:
    """By the thesis' equations, likewise."""
    return {record.name: record.second for record in records if not record.error}


def verdicts_of(studies: Sequence[Study], judgements: Judgements) -> list[Verdict]:
    """Those of every statement of the studies that were run."""
    return [verdict for study in studies if study.name in judgements for verdict in study.verdicts(judgements[study.name])]


def overview(records: Sequence[Record], markup: Markup) -> list[str]:
    """How many tables and figures, statements and conclusions have each verdict, in nature and by the thesis' equations."""
    both = (IN_NATURE, first_verdicts(records)), (BY_EQUATIONS, second_verdicts(records))
    body = [[f"{what}, {by}", *numbers] for what in COUNTED for by, found in both for numbers in [count(what, found)]]
    failed = [record.name for record in records if record.error]
    parts = [markup.table(["", *(shown_verdict(verdict) for verdict in Verdict)], body), *own_checks(records, markup)]
    return [*parts, markup.paragraph(f"Failed: {', '.join(failed)}.")] if failed else parts


def own_checks(records: Sequence[Record], markup: Markup) -> list[str]:
    """How many of the checks of our own work hold, in a sentence of their own."""
    verdicts = verdicts_of(catalogue.FUTURE_WORK[1], first_verdicts(records))
    held = verdicts.count(Verdict.REPRODUCED)
    return [markup.paragraph(f"Of the {len(verdicts)} checks of “{catalogue.FUTURE_WORK[0]}” {held} hold.")] if verdicts else []


COUNTED = ("tables and figures", "their statements", "concluding statements")


def count(what: str, found: Judgements) -> list[str]:
    """How many of the thesis' tables and figures, statements or conclusions have each verdict."""
    judged = [study for study in catalogue.THESIS_STUDIES if study.name in found]
    verdicts: Sequence[Verdict | None]
    if what == COUNTED[0]:
        verdicts = [study.verdict(found[study.name]) for study in judged]
    elif what == COUNTED[1]:
        verdicts = verdicts_of(judged, found)
    else:
        verdicts = [row.verdict(found) for row in ROWS]
    return [str(number) for number in counts(verdicts).values()]


def why(records: Sequence[Record]) -> str:
    """Why so many verdicts are negative: what of it is the thesis' model, its arithmetic, and the strict rules, in numbers."""
    first, second = (verdicts_of(catalogue.THESIS_STUDIES, found(records)) for found in (first_verdicts, second_verdicts))
    pairs = list(zip(first, second, strict=True))
    missed = [again for verdict, again in pairs if verdict in (Verdict.TREND, Verdict.NOT_REPRODUCED)]
    found, lost = counts(missed), sum(v is Verdict.REPRODUCED and again is not v for v, again in pairs)
    figures = [study for study in catalogue.THESIS_STUDIES if study.name in first_verdicts(records)]
    fallen = [study.verdicts(first_verdicts(records)[study.name]) for study in figures]
    partly = sum(Verdict.NOT_REPRODUCED in each and Verdict.REPRODUCED in each for each in fallen)
    none = sum(Verdict.NOT_REPRODUCED in each for each in fallen)
    return (
        f"Why so many are negative. Of {len(first)} statements {len(missed)} are not so in nature, {first.count(Verdict.TREND)} of "
        "which hold in trend. "
        f"The thesis' model accounts for {found[Verdict.REPRODUCED]}: by its own equations they are right. {found[Verdict.TREND]} "
        f"keep a trend by them, {found[Verdict.NOT_REPRODUCED]} do not: there it is the thesis' arithmetic, values read off plots, "
        "loads, weights or lay-ups that it does not print, and what it saw in four curves and stated of all. "
        f"{found[Verdict.UNTESTABLE]} cannot be evaluated. {lost} that are so in nature do not follow from its equations or cannot "
        "be evaluated. The rest is the strict rule: one step in hundreds that goes the other way leaves a trend, and one statement "
        f"that fails makes a table or figure fail: of the {none} that fail in nature, {partly} have other statements that hold."
    )


def equations(markup: Markup) -> str:
    """The thesis' equations that the second verdicts take in place of ours."""
    rows = [[equation.name, equation.place, equation.words, equation.refuted or "counts"] for equation in EQUATIONS]
    return markup.table(["equation", "where", "as the thesis has it", "in the second verdict"], rows)


def stumbling(records: Sequence[Record], markup: Markup) -> list[str]:
    """What a reader who compares with the thesis stumbles over first, and why."""
    return [markup.heading(2, "What a reader stumbles over"), rows_table(STUMBLING, "where", records, markup)]


def ledger(records: Sequence[Record], markup: Markup) -> list[str]:
    """The concluding statements."""
    return [markup.heading(2, "Concluding statements"), rows_table(ROWS, "section", records, markup)]


def rows_table(rows: Sequence[Row], place: str, records: Sequence[Record], markup: Markup) -> str:
    """Statements with both verdicts, and why."""
    first, second = first_verdicts(records), second_verdicts(records)
    header = [place, "statement", IN_NATURE, BY_EQUATIONS, "decided by", "why"]
    return markup.table(header, [ledger_row(row, first, second) for row in rows])


def ledger_row(row: Row, first: Judgements, second: Judgements) -> list[str]:
    """One of them with both verdicts."""
    verdict, again = row.verdict(first), row.verdict(second)
    deciding = ", ".join(dict.fromkeys(study for study, _ in row.decided_by)) or "nothing"
    shown = [shown_verdict(verdict) if verdict else "not run", shown_second(again) if again else "not run"]
    return [row.section, row.text, *shown, deciding, row.remark if {verdict, again} != {Verdict.REPRODUCED} else ""]
