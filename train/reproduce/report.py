"""The one page: ledger first, then table by table and figure by figure, as Markdown and as self-contained HTML."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from train.reproduce import catalogue
from train.reproduce.markup import Markup, as_html, as_markdown
from train.reproduce.overview import FUTURE_WORK_INTRODUCTION, opening
from train.reproduce.runner import Record
from train.reproduce.section import section

TITLE = "The thesis, regenerated and judged"
STYLE = """
body{font:15px/1.45 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a}
table{border-collapse:collapse;margin:.6rem 0;font-size:13px}
td,th{border:1px solid #ccc;padding:.25rem .5rem;text-align:left;vertical-align:top}
th{background:#f3f3f3}img{max-width:100%;height:auto}h3{margin-top:2.4rem}.wide{overflow-x:auto}td.v{white-space:nowrap}
"""


def markdown_page(records: Sequence[Record], pictures: str = ".") -> str:
    """The page as Markdown, its pictures in the folder ``pictures`` relative to it."""
    return "\n".join(page(records, as_markdown(pictures)))


def html_page(records: Sequence[Record], folder: Path) -> str:
    """The page as HTML with its pictures, which are read from ``folder``, inside."""
    body = "\n".join(page(records, as_html(folder)))
    return f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{TITLE}</title><style>{STYLE}</style>\n{body}\n</html>\n'


def page(records: Sequence[Record], markup: Markup) -> list[str]:
    """The page's parts in order."""
    known = {record.name: record for record in records}
    parts = [markup.heading(1, TITLE), *opening(records, markup)]
    for chapter in catalogue.CHAPTERS:
        title, studies = chapter
        shown = [study for study in studies if study.name in known]
        if shown:
            parts.append(markup.heading(2, title))
            parts += [markup.paragraph(FUTURE_WORK_INTRODUCTION)] if chapter == catalogue.FUTURE_WORK else []
        for study in shown:
            parts += section(study, known[study.name], markup)
    return parts
