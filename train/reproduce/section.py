"""One table or figure on the page: what is stated of it, both verdicts, its picture."""

from __future__ import annotations

from collections.abc import Sequence

from train.reproduce import catalogue
from train.reproduce.judging.second import Second
from train.reproduce.judging.study import Statement, Study
from train.reproduce.judging.verdicts import Judgement, Verdict
from train.reproduce.markup import Markup
from train.reproduce.runner import Record
from train.reproduce.thesis.equations import TOGETHER

SYMBOL = {Verdict.REPRODUCED: "●", Verdict.TREND: "◐", Verdict.NOT_REPRODUCED: "○", Verdict.UNTESTABLE: "–"}
OWN_WORDS = {
    Verdict.REPRODUCED: "holds",
    Verdict.TREND: "holds nearly",
    Verdict.NOT_REPRODUCED: "does not hold",
    Verdict.UNTESTABLE: "cannot be tested",
}
"""Of our own work, where nothing of the thesis is reproduced."""
IN_NATURE, BY_EQUATIONS = "in nature", "by the thesis' equations"
"""The two columns of verdicts."""
MANY = 12
"""Rows of numbers beyond which they are folded."""


def shown_verdict(verdict: Verdict) -> str:
    """A verdict with a symbol that can be found at a glance, in print too."""
    return f"{SYMBOL[verdict]} {verdict.value}"


def shown_second(verdict: Verdict) -> str:
    """The same of a second verdict."""
    return f"{SYMBOL[verdict]} cannot be evaluated" if verdict is Verdict.UNTESTABLE else shown_verdict(verdict)


def shown_own(verdict: Verdict) -> str:
    """The same of our own work, in its words."""
    return f"{SYMBOL[verdict]} {OWN_WORDS[verdict]}"


def own_rule(words: str) -> str:
    """A rule's words for our own work."""
    changed = (("not reproduced", OWN_WORDS[Verdict.NOT_REPRODUCED]), ("reproduced", OWN_WORDS[Verdict.REPRODUCED]))
    for theirs, ours in (*changed, ("trend", "nearly")):
        words = words.replace(theirs, ours)
    return words


def section(study: Study, record: Record, markup: Markup) -> list[str]:
    """One table or figure: both verdicts, the picture, what is stated, what is to be known of it, and folded how it is judged."""
    heading, configuration = markup.heading(3, study.heading, study.name), markup.paragraph(f"Computed: {study.configuration}.")
    if record.error:
        return [heading, configuration, markup.paragraph(f"This study failed: {record.error}")]
    own = study in catalogue.FUTURE_WORK[1]
    told = remarks(study) if own else [*remarks(study), *tellings(study, record)]
    return [
        heading,
        markup.paragraph(own_verdict(study, record) if own else both_verdicts(study, record)),
        markup.image(study.name, study.heading),
        configuration,
        own_table(study, record, markup) if own else statement_table(study, record, markup),
        *([markup.listed(told)] if told else []),
        *(markup.paragraph(text) for text in record.notes),
        markup.folded("By which rule each is judged", rules(study, markup, own)),
        *number_table(record, markup),
    ]


def remarks(study: Study) -> list[str]:
    """What is to be known of statements, each with those that it is of."""
    found: dict[str, list[str]] = {}
    for each in study.statements:
        if each.remark:
            found.setdefault(each.remark, []).append(f"“{each.text}”")
    return [f"{', '.join(texts)}: {remark}" for remark, texts in found.items()]


def number_table(record: Record, markup: Markup) -> list[str]:
    """A table's numbers, folded where they are many; empty without any."""
    if not record.rows:
        return []
    shown = markup.table(record.header, record.rows)
    return [shown if len(record.rows) <= MANY else markup.folded(f"The numbers, {len(record.rows)} rows", shown)]


def rules(study: Study, markup: Markup, own: bool) -> str:
    """The rule of every statement in words."""
    worded_rules = [(worded(each), own_rule(each.rule.words) if own else each.rule.words) for each in study.statements]
    return markup.table(["statement", "rule"], worded_rules)


def own_verdict(study: Study, record: Record) -> str:
    """The verdict of our own work, with how many of its statements hold."""
    verdicts = study.verdicts(record.judgements)
    held = share(verdicts)
    return f"Check: {shown_own(study.verdict(record.judgements))} ({held})."


def both_verdicts(study: Study, record: Record) -> str:
    """Both verdicts of a table or figure."""
    first, second = study.verdict(record.judgements), study.verdict(record.second)
    shares = share(study.verdicts(record.judgements)), share(study.verdicts(record.second))
    return (
        f"In nature: {shown_verdict(first)} ({shares[0]}). By the thesis' equations: {shown_second(second)} ({shares[1]}"
        f"{taken_as_printed(study)})."
    )


def share(verdicts: Sequence[Verdict]) -> str:
    """How many of them are reproduced."""
    return f"{verdicts.count(Verdict.REPRODUCED)} of {len(verdicts)} statements hold"


def taken_as_printed(study: Study) -> str:
    """What the second verdict takes as the thesis has it, in words."""
    if study.printed is not None:
        return ", judged by the layouts that it prints"
    names = [name for name in TOGETHER if name in study.rests_on]
    return f", with its {', '.join(names)}" if names else ""


def statement_table(study: Study, record: Record, markup: Markup) -> str:
    """Every statement with both verdicts, where there are two."""
    rows = []
    for statement in study.statements:
        found = record.judgements[statement.key]
        again = second_cell(record.second[statement.key], found) if statement.key in record.second else ""
        rows.append([worded(statement), *numbers(found), shown_verdict(found.verdict), again])
    return markup.table(["statement", "thesis", "ours", "deviation", IN_NATURE, BY_EQUATIONS], rows)


def own_table(study: Study, record: Record, markup: Markup) -> str:
    """Every statement of our own work, with one verdict."""
    rows = []
    for statement in study.statements:
        found = record.judgements[statement.key]
        rows.append([worded(statement), *numbers(found), shown_own(found.verdict)])
    return markup.table(["statement", "expected", "ours", "deviation", "check"], rows)


def worded(statement: Statement) -> str:
    """Its text."""
    return f"Our own question: {statement.text}" if statement.aside else statement.text


def numbers(found: Judgement) -> tuple[str, str, str]:
    """What the thesis has, what we have, and how far these are apart."""
    return found.thesis, found.ours, found.deviation


def second_cell(second: Second, first: Judgement) -> str:
    """The second verdict with the numbers of the thesis' equations, where they differ from ours, and which of them it needs."""
    text = shown_second(second.verdict)
    if not second.reason and (second.ours, second.deviation) != (first.ours, first.deviation):
        text += f": {second.ours}, {second.deviation}" if second.deviation != second.ours else f": {second.ours}"
    return f"{text}; with its {', '.join(second.enough)}" if second.enough else text


def tellings(study: Study, record: Record) -> list[str]:
    """Why some cannot be evaluated by the thesis' equations, and what misprints that it refutes would make of others."""
    seconds = [(statement.text, record.second[statement.key]) for statement in study.own_statements]
    reasons = dict.fromkeys(second.reason for _, second in seconds if second.reason)
    return [
        *(f"Not evaluated by the thesis' equations: {reason.rstrip('.')}." for reason in reasons),
        *(f"“{text}”, {sentence}." for text, second in seconds for sentence in second.told),
    ]
