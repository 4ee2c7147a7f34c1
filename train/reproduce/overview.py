"""What the pages open with: what is judged and how, how many of each verdict there are, and why so many are negative."""

from __future__ import annotations

from collections.abc import Sequence

from train.reproduce import catalogue
from train.reproduce.index import first_verdicts, second_verdicts
from train.reproduce.judging.ledger import ROWS, Judgements, Row, counts, of
from train.reproduce.judging.study import Study
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.markup import Link, Markup, Text
from train.reproduce.runner import Record
from train.reproduce.section import BY_EQUATIONS, IN_NATURE, shown_verdict
from train.reproduce.thesis.equations import EQUATIONS

INTRODUCTION = (
    "D. N. Vadiraja, Vibration Analysis, Control and Optimal Placement of MFC Actuators and Sensors on Rotating Thin-Walled "
    "Composite Cantilever Beams, IIT Guwahati, 2008. `beamenv reproduce` computes every table and figure of its chapters 2, 3, 5 "
    "and 6 again, and judges every statement that it makes of them. Each verdict follows from numbers by a fixed rule; numbers and "
    "rule stand beside it."
)
DEFINITIONS: tuple[Text, ...] = (
    "Each statement has two verdicts. In nature: is it true of the blade? Nobody has measured this blade, so a model answers: the "
    "thesis' own kind of model with its errors corrected. It is not the blade's model that the environment uses, which is checked "
    "against 3-D finite elements. Where the two are known to differ, in frequencies by up to a tenth, is listed in ",
    Link("Physics", "physics.md#two-models"),
    "; statements that rest on such differences may be judged otherwise by the blade's model. By the thesis' equations: does it "
    "hold in the same derivation of ours, with five of the thesis' readings in place of ours?",
)
SYMBOLS = (
    f"{shown_verdict(Verdict.REPRODUCED)}: it holds.",
    f"{shown_verdict(Verdict.TREND)}: it holds on the whole, but not in every case, or not to the number.",
    f"{shown_verdict(Verdict.NOT_REPRODUCED)}: it does not hold.",
    f"{shown_verdict(Verdict.UNTESTABLE)}, or evaluated: the thesis does not say enough.",
)
WEAKEST = (
    "A table, a figure or a conclusion has the weakest verdict of those statements it stands on that can be tested; where none "
    "can, it cannot be tested either. The rules are strict in most places, but lenient in some: “marginally up” leaves a trend to "
    "any rise, “within 1.66 %” is judged at 2 %, and “close agreement” is 4 %."
)
LETTERS = (
    "Letters are the thesis': θ is the ply angle, η the taper (in the cost also the weight of the voltages), θp the angle of a "
    "patch's fibres, φ the twist, ψ the torsional function of a closed cell; u, v and s are displacements in lag, in flap and "
    "along the span, θx and θy rotations of the section. CUS and CAS are boxes of circumferentially uniform and asymmetric "
    "stiffness. a22 and a33 are the bending stiffnesses in lag and flap, ã2 is what the higher-order theory adds to the "
    "coupling of bending and shear. tr(P) and tr(S) are traces of the regulator's and the filter's Riccati solutions, by which "
    "actuators and sensors are placed."
)
HOW: tuple[tuple[Text, ...], ...] = (
    (
        "The verdict in nature rests on the thesis' own kind of model, derived again from its energies, with the shear flow that a "
        "closed cell asks for. It was checked against what others measured and computed (",
        Link("Validation", "validation.md"),
        "), but it is not the blade's model of the environment. What it still leaves out of nature is listed in the ",
        Link("errata", "thesis-errata.md"),
        ".",
    ),
    (
        "The verdict by the thesis' equations rests on the same computation with the equations of the table below in place of "
        "ours, all at once that bear on a figure. Chapter 6 prints no weights; it is judged by the layouts that it prints. "
        "Where a statement holds better in this way, the page names the equation that does it alone, the first in the table's "
        "order, or those that are needed together. What the thesis itself refutes, by its text, tables or equations, is tried "
        "last and told, but counts for nothing.",
    ),
    (
        "Questions of our own stand beside the thesis' statements and decide nothing. Step loads are 30 N/m, so that the limit "
        "of ±1500 V matters. The thesis prints a load for chapter 6 only: section 6.5 has 500 kg/m, as a weight 4905 N/m, which is "
        "far more than its patches can balance. Where chapter 5 is computed with 500 N/m too, this number is taken as N/m. Where "
        "the thesis leaves a configuration open or misprints it, the page names the one that was computed.",
    ),
)
FUTURE_WORK_INTRODUCTION: tuple[Text, ...] = (
    "What the thesis' section 7.2 left to others, and is there now; in words: ",
    Link("Beyond the thesis", "beyond-the-thesis.md"),
    ". Nothing of the thesis is reproduced here: the statements are ours, written with the numbers at hand, and are counted "
    "apart. Where a closed form, a published number or an independent computation is named, one that holds is a validation; a "
    "limit or an order of our own that holds is a regression check: the code still gives what it gave when we looked.",
)
COMPARED = Row(
    "3.5",
    "Its comparisons with an experiment and with other authors (Tables 3.2 to 3.4) hold here too.",
    of("table-3.2", "experiment", "theory") + of("table-3.3", "oh") + of("table-3.4", "chandiramani"),
)
COUNTED = ("tables and figures", "their statements", "concluding statements")


def opening(records: Sequence[Record], markup: Markup) -> list[str]:
    """What is judged, the counts, and why so many are negative."""
    return [
        markup.paragraph(INTRODUCTION),
        markup.paragraph(*DEFINITIONS),
        markup.listed(SYMBOLS),
        markup.paragraph(WEAKEST),
        markup.paragraph(LETTERS),
        *overview(records, markup),
        markup.heading(2, "Why so many verdicts are negative", ""),
        markup.paragraph(why(records)),
    ]


def how(markup: Markup) -> list[str]:
    """How both verdicts are made."""
    told = [markup.paragraph(*pieces) for pieces in HOW]
    return [markup.heading(2, "How the verdicts are made", ""), *told, equations(markup)]


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
    told = f"Counted apart: of the {len(verdicts)} checks of what section 7.2 left to others, {held} hold."
    return [markup.paragraph(told)] if verdicts else []


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
    """Why so many verdicts are negative: strict rules, the thesis' equations, and what neither explains, in numbers."""
    first, second = (verdicts_of(catalogue.THESIS_STUDIES, found(records)) for found in (first_verdicts, second_verdicts))
    pairs = list(zip(first, second, strict=True))
    missed = [again for verdict, again in pairs if verdict in (Verdict.TREND, Verdict.NOT_REPRODUCED)]
    alike = pairs.count((Verdict.TREND, Verdict.TREND))
    found, lost = counts(missed), sum(v is Verdict.REPRODUCED and again is not v for v, again in pairs)
    figures = [study for study in catalogue.THESIS_STUDIES if study.name in first_verdicts(records)]
    fallen = [study.verdicts(first_verdicts(records)[study.name]) for study in figures]
    partly = sum(Verdict.NOT_REPRODUCED in each and Verdict.REPRODUCED in each for each in fallen)
    none = sum(Verdict.NOT_REPRODUCED in each for each in fallen)
    compared = f" {COMPARED.text}" if COMPARED.verdict(first_verdicts(records)) is Verdict.REPRODUCED else ""
    return (
        f"Of {len(first)} statements {first.count(Verdict.REPRODUCED)} hold in nature, {first.count(Verdict.TREND)} hold in trend, "
        f"{first.count(Verdict.NOT_REPRODUCED)} do not hold and {first.count(Verdict.UNTESTABLE)} cannot be tested. "
        "Strict rules are one reason: one step in hundreds that goes the other way leaves only a trend, and one statement that "
        f"fails makes its table or figure fail. Of the {none} that fail in nature, {partly} have other statements that hold. This "
        "explains trends, tables and figures, but no statement that does not hold. "
        f"The thesis' model is another. Of the {len(missed)} statements that do not fully hold in nature, its equations explain "
        f"{found[Verdict.REPRODUCED]}, and {found[Verdict.TREND]} in trend: these follow, fully or in trend, from equations that "
        f"do not hold of the blade, but {alike} of the {found[Verdict.TREND]} are no more than a trend in nature too. The rest is "
        f"unexplained: {found[Verdict.NOT_REPRODUCED]} do not follow from the thesis' equations either, and "
        f"{found[Verdict.UNTESTABLE]} cannot be evaluated by them. Loads and weights that the thesis does not print, or a "
        "configuration that differs from the caption's, may lie behind them; which, we cannot tell. Some "
        "may be our fault: where a configuration is not printed, we had to choose one; the model behind both verdicts has errors "
        "that are known; and our derivation may have others, which no check has shown. The reverse "
        f"happens too: {lost} statements that hold in nature do not follow from the thesis' equations, or cannot be evaluated by "
        f"them.{compared}"
    )


def equations(markup: Markup) -> str:
    """The thesis' equations that the second verdicts take in place of ours."""
    rows = [[equation.name, equation.place, equation.words, equation.refuted or "counts"] for equation in EQUATIONS]
    return markup.table(["equation", "where", "as the thesis has it", "in the second verdict"], rows)
