"""The pages: an index of all verdicts and a page for each chapter, or all in one, as Markdown and as self-contained HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from train.reproduce import catalogue
from train.reproduce.catalogue import Chapter
from train.reproduce.index import conclusions, index, stumbling
from train.reproduce.markup import Link, Markup, as_html, as_markdown, slug
from train.reproduce.overview import FUTURE_WORK_INTRODUCTION, how, opening
from train.reproduce.runner import Record
from train.reproduce.section import section

TITLE = "The thesis, regenerated and judged"
INDEX = "thesis.md"
"""The page that leads to all others."""
SIGNS = (
    "Every table and figure of the chapter, computed again. Orange signs in a figure are numbers that the thesis prints in its "
    "tables or its text; what it shows in a plot alone is not read off. A verdict in nature rests on the thesis' "
    "own kind of model with its errors corrected, not on the blade's model that the environment uses."
)
STYLE = """
body{font:15px/1.45 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a}
table{border-collapse:collapse;margin:.6rem 0;font-size:13px}
td,th{border:1px solid #ccc;padding:.25rem .5rem;text-align:left;vertical-align:top}
th{background:#f3f3f3}img{max-width:100%;height:auto}h3{margin-top:2.4rem}.wide{overflow-x:auto}td.v{white-space:nowrap}
summary{cursor:pointer;color:#1f5f99}
"""


def markdown_page(records: Sequence[Record], pictures: str = ".") -> str:
    """All in one page as Markdown, its pictures in the folder ``pictures`` relative to it."""
    return "\n".join(page(records, as_markdown(pictures)))


def html_page(records: Sequence[Record], folder: Path) -> str:
    """All in one page as HTML with its pictures, which are read from ``folder``, inside."""
    body = "\n".join(page(records, as_html(folder)))
    return f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{TITLE}</title><style>{STYLE}</style>\n{body}\n</html>\n'


def page(records: Sequence[Record], markup: Markup) -> list[str]:
    """Index and chapters in order."""
    parts = index_parts(records, markup)
    for chapter in chapters(records):
        parts += chapter_parts(2, chapter, records, markup)
    return parts


def documentation(records: Sequence[Record], pictures: str) -> Mapping[str, str]:
    """The pages of the documentation, by their files' names: the index, and one for each chapter of which something was run."""
    files = {title: f"thesis-{slug(title)}.md" for title, _ in chapters(records)}
    targets = {study.name: f"{files[title]}#{slug(study.name)}" for title, studies in chapters(records) for study in studies}
    markup = as_markdown(pictures, {**files, **targets, TITLE: INDEX})
    pages = {files[chapter[0]]: "\n".join(chapter_parts(1, chapter, records, markup)) for chapter in chapters(records)}
    return {INDEX: "\n".join(index_parts(records, markup)), **pages}


def chapters(records: Sequence[Record]) -> list[Chapter]:
    """Those of which something was run, with what was run of them."""
    known = {record.name for record in records}
    run = [(title, tuple(study for study in studies if study.name in known)) for title, studies in catalogue.CHAPTERS]
    return [chapter for chapter in run if chapter[1]]


def index_parts(records: Sequence[Record], markup: Markup) -> list[str]:
    """Counts, why so many are negative, where one stumbles, every item and conclusion, and how it is all judged."""
    return [
        markup.heading(1, TITLE, ""),
        *opening(records, markup),
        *stumbling(records, markup),
        *index(records, markup),
        *conclusions(records, markup),
        *how(markup),
    ]


def chapter_parts(level: int, chapter: Chapter, records: Sequence[Record], markup: Markup) -> list[str]:
    """A chapter under a heading of a level, item by item."""
    known = {record.name: record for record in records}
    title, studies = chapter
    own = title == catalogue.FUTURE_WORK[0]
    lead = markup.paragraph(*(FUTURE_WORK_INTRODUCTION if own else (SIGNS,)))
    parts = [markup.heading(level, title, title if level > 1 else ""), lead]
    parts += [markup.paragraph("All verdicts in one list, and how they are made: ", Link(TITLE, TITLE), ".")] if level == 1 else []
    return [*parts, *(part for study in studies for part in section(study, known[study.name], markup))]
