"""The one page: ledger first, then table by table and figure by figure, as Markdown and as self-contained HTML."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from train.reproduce.catalogue import CHAPTERS, FUTURE_WORK, THESIS_STUDIES
from train.reproduce.judging.ledger import ROWS, Judgements, counts
from train.reproduce.judging.study import Study
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.runner import Record
from train.shared import markdown

TITLE = "The thesis, regenerated and judged"
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
FUTURE_WORK_INTRODUCTION = (
    "What the thesis' section 7.2 left to others, and is there now (in words: docs/beyond-the-thesis.md). These statements are our "
    "own, judged by the same rules: what is expected is a closed form, a published number or an independent computation. They "
    "are counted apart."
)
SYMBOL = {Verdict.REPRODUCED: "●", Verdict.TREND: "◐", Verdict.NOT_REPRODUCED: "○", Verdict.UNTESTABLE: "–"}
STYLE = """
body{font:15px/1.45 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a}
table{border-collapse:collapse;margin:.6rem 0;font-size:13px}
td,th{border:1px solid #ccc;padding:.25rem .5rem;text-align:left;vertical-align:top}
th{background:#f3f3f3}img{max-width:100%;height:auto}h3{margin-top:2.4rem}.wide{overflow-x:auto}td.v{white-space:nowrap}
"""


@dataclass(frozen=True, slots=True)
class Markup:
    """How a page is written in one language."""

    heading: Callable[[int, str], str]
    paragraph: Callable[[str], str]
    table: Callable[[Sequence[str], Sequence[Sequence[str]]], str]
    image: Callable[[str], str]


def html_table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """An HTML table."""
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><tr>{head}</tr>{body}</table></div>'


def embedded(folder: Path, name: str) -> str:
    """A picture as part of the page itself."""
    data = base64.b64encode((folder / f"{name}.png").read_bytes()).decode()
    return f'<p><img alt="{html.escape(name)}" src="data:image/png;base64,{data}"></p>'


def markdown_page(records: Sequence[Record], pictures: str = ".") -> str:
    """The page as Markdown, its pictures in the folder ``pictures`` relative to it."""
    markup = Markup(
        heading=lambda level, text: f"{'#' * level} {text}\n",
        paragraph=lambda text: f"{text}\n",
        table=lambda header, rows: f"{markdown.table(header, rows)}\n",
        image=lambda name: f"![{name}]({pictures}/{name}.png)\n",
    )
    return "\n".join(page(records, markup))


def html_page(records: Sequence[Record], folder: Path) -> str:
    """The page as HTML with its pictures, which are read from ``folder``, inside."""
    markup = Markup(
        heading=lambda level, text: f"<h{level}>{html.escape(text)}</h{level}>",
        paragraph=lambda text: f"<p>{html.escape(text)}</p>",
        table=html_table,
        image=lambda name: embedded(folder, name),
    )
    body = "\n".join(page(records, markup))
    return f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{TITLE}</title><style>{STYLE}</style>\n{body}\n</html>\n'


def page(records: Sequence[Record], markup: Markup) -> list[str]:
    """The page's parts in order."""
    known = {record.name: record for record in records}
    parts = [markup.heading(1, TITLE), markup.paragraph(INTRODUCTION), *overview(records, markup), *ledger(records, markup)]
    for title, studies in CHAPTERS:
        shown = [study for study in studies if study.name in known]
        if shown:
            parts.append(markup.heading(2, title))
            parts += [markup.paragraph(FUTURE_WORK_INTRODUCTION)] if (title, studies) == FUTURE_WORK else []
        for study in shown:
            parts += section(study, known[study.name], markup)
    return parts


def shown_verdict(verdict: Verdict) -> str:
    """A verdict with a symbol that can be found at a glance, in print too."""
    return f"{SYMBOL[verdict]} {verdict.value}"


def overview(records: Sequence[Record], markup: Markup) -> list[str]:
    """How many tables and figures, statements and conclusions have each verdict."""
    judgements = {record.name: record.judgements for record in records if not record.error}
    judged = [(study, judgements[study.name]) for study in THESIS_STUDIES if study.name in judgements]
    studies = counts([study.verdict(found) for study, found in judged])
    statements = counts(verdicts_of(THESIS_STUDIES, judgements))
    checks = counts(verdicts_of(FUTURE_WORK[1], judgements))
    rows = counts([row.verdict(judgements) for row in ROWS])
    header = ["", *(shown_verdict(verdict) for verdict in Verdict)]
    body = [
        ["tables and figures", *(str(number) for number in studies.values())],
        ["their statements", *(str(number) for number in statements.values())],
        ["concluding statements", *(str(number) for number in rows.values())],
    ]
    if sum(checks.values()):
        body.append([f"checks of “{FUTURE_WORK[0]}”", *(str(number) for number in checks.values())])
    failed = [record.name for record in records if record.error]
    parts = [markup.table(header, body)]
    return [*parts, markup.paragraph(f"Failed: {', '.join(failed)}.")] if failed else parts


def verdicts_of(studies: Sequence[Study], judgements: Judgements) -> list[Verdict]:
    """Those of every statement of the studies that were run."""
    return [verdict for study in studies if study.name in judgements for verdict in study.verdicts(judgements[study.name])]


def ledger(records: Sequence[Record], markup: Markup) -> list[str]:
    """The concluding statements."""
    judgements = {record.name: record.judgements for record in records if not record.error}
    rows = []
    for row in ROWS:
        verdict = row.verdict(judgements)
        deciding = ", ".join(dict.fromkeys(study for study, _ in row.decided_by)) or "nothing"
        why = row.remark if verdict is not Verdict.REPRODUCED else ""
        rows.append([row.section, row.text, shown_verdict(verdict) if verdict else "not run", deciding, why])
    return [
        markup.heading(2, "Concluding statements"),
        markup.table(["section", "statement", "verdict", "decided by", "why"], rows),
    ]


def section(study: Study, record: Record, markup: Markup) -> list[str]:
    """One table or figure."""
    parts = [
        markup.heading(3, study.heading),
        markup.paragraph(f"Configuration: {study.configuration}."),
    ]
    if record.error:
        return [*parts, markup.paragraph(f"This study failed: {record.error}")]
    rows = []
    for statement in study.statements:
        found = record.judgements[statement.key]
        text = f"Our own question: {statement.text}" if statement.aside else statement.text
        cells = [text, found.thesis, found.ours, found.deviation, shown_verdict(found.verdict), statement.rule.words]
        rows.append(cells)
    verdicts = study.verdicts(record.judgements)
    share = f"{verdicts.count(Verdict.REPRODUCED)} of {len(verdicts)} statements reproduced"
    parts.append(markup.paragraph(f"Verdict: {shown_verdict(study.verdict(record.judgements))} ({share})."))
    source = "expected" if study in FUTURE_WORK[1] else "thesis"
    parts.append(markup.table(["statement", source, "ours", "deviation", "verdict", "rule"], rows))
    remarks = dict.fromkeys(statement.remark for statement in study.statements if statement.remark)
    parts += [markup.paragraph(text) for text in (*remarks, *record.notes)]
    parts.append(markup.image(study.name))
    if record.rows:
        parts.append(markup.table(record.header, record.rows))
    return parts
