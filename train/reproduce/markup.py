"""How the pages are written, as Markdown and as HTML."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from train.shared import markdown


@dataclass(frozen=True, slots=True)
class Link:
    """A reference to a table or figure by its name, to a chapter by its title, or to a page of the documentation by its file."""

    text: str
    to: str

    @property
    def leads_away(self) -> bool:
        """Whether it is to a page that only the documentation has; it is plain text elsewhere."""
        return self.to.partition("#")[0].endswith(".md")


Text = str | Link
"""A piece of a paragraph."""
Cell = Text | tuple[Text, ...]
"""Of a table; several are listed."""


@dataclass(frozen=True, slots=True)
class Markup:
    """How a page is written in one language."""

    heading: Callable[[int, str, str], str]
    """Of a level, a text and the name by which links find it, which may be empty."""
    paragraph: Callable[..., str]
    """Of one or several pieces of text."""
    listed: Callable[[Sequence[str]], str]
    table: Callable[[Sequence[str], Sequence[Sequence[Cell]]], str]
    image: Callable[[str, str], str]
    """Of a name and what it shows."""
    folded: Callable[[str, str], str]
    """A line that opens what it hides."""


def as_markdown(pictures: str, targets: Mapping[str, str] | None = None) -> Markup:
    """Markdown, with the pictures in the folder ``pictures`` relative to it.

    ``targets`` has the addresses of what links lead to, by name; the rest is on this page.
    """

    def text(piece: Text) -> str:
        if isinstance(piece, str) or (targets is None and piece.leads_away):
            return piece if isinstance(piece, str) else piece.text
        own = piece.to if piece.leads_away else f"#{slug(piece.to)}"
        return f"[{piece.text}]({(targets or {}).get(piece.to, own)})"

    def heading(level: int, words: str, name: str) -> str:
        anchor = f'<a id="{slug(name)}"></a>\n\n' if name else ""
        return f"{anchor}{'#' * level} {words}\n"

    def cell(content: Cell) -> str:
        pieces = content if isinstance(content, tuple) else (content,)
        return ", ".join(markdown.escaped(each) if isinstance(each, str) else text(each) for each in pieces)

    def table(header: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
        lines = [[cell(each) for each in row] for row in rows]
        return f"{markdown.markup_table([markdown.escaped(each) for each in header], lines)}\n"

    return Markup(
        heading=heading,
        paragraph=lambda *pieces: "".join(map(text, pieces)) + "\n",
        listed=lambda points: "".join(f"- {markdown.escaped(point)}\n" for point in points),
        table=table,
        image=lambda name, shows: f"![{shows}]({pictures}/{name}.png)\n",
        folded=lambda summary, body: f"{markdown.folded(summary, body.rstrip())}\n",
    )


def as_html(folder: Path) -> Markup:
    """HTML, with the pictures, which are read from ``folder``, inside."""
    return Markup(
        heading=lambda level, words, name: f"<h{level}{identity(name)}>{html.escape(words)}</h{level}>",
        paragraph=lambda *pieces: f"<p>{''.join(map(html_text, pieces))}</p>",
        listed=lambda points: f"<ul>{''.join(f'<li>{html.escape(point)}</li>' for point in points)}</ul>",
        table=html_table,
        image=lambda name, shows: embedded(folder, name, shows),
        folded=lambda summary, body: f"<details><summary>{html.escape(summary)}</summary>{body}</details>",
    )


def html_text(piece: Text) -> str:
    """Escaped, a link as such."""
    if isinstance(piece, str) or piece.leads_away:
        return html.escape(piece if isinstance(piece, str) else piece.text)
    return f'<a href="#{slug(piece.to)}">{html.escape(piece.text)}</a>'


def html_cell(content: Cell) -> str:
    """One or several pieces."""
    return ", ".join(map(html_text, content if isinstance(content, tuple) else (content,)))


def html_table(header: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    """An HTML table."""
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
    body = "".join("<tr>" + "".join(f"<td>{html_cell(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><tr>{head}</tr>{body}</table></div>'


def identity(name: str) -> str:
    """The attribute by which links find a heading; nothing without a name."""
    return f' id="{slug(name)}"' if name else ""


def embedded(folder: Path, name: str, shows: str) -> str:
    """A picture as part of the page itself."""
    data = base64.b64encode((folder / f"{name}.png").read_bytes()).decode()
    return f'<p><img alt="{html.escape(shows)}" src="data:image/png;base64,{data}"></p>'


def slug(name: str) -> str:
    """A name as pages and their addresses have it: "figure-3.2", "chapter-3" for "Chapter 3: vibration"."""
    return name.partition(":")[0].lower().replace(" ", "-")
