"""How the page is written, as Markdown and as HTML."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from train.shared import markdown


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


def as_markdown(pictures: str) -> Markup:
    """Markdown, with the pictures in the folder ``pictures`` relative to it."""
    return Markup(
        heading=lambda level, text: f"{'#' * level} {text}\n",
        paragraph=lambda text: f"{text}\n",
        table=lambda header, rows: f"{markdown.table(header, rows)}\n",
        image=lambda name: f"![{name}]({pictures}/{name}.png)\n",
    )


def as_html(folder: Path) -> Markup:
    """HTML, with the pictures, which are read from ``folder``, inside."""
    return Markup(
        heading=lambda level, text: f"<h{level}>{html.escape(text)}</h{level}>",
        paragraph=lambda text: f"<p>{html.escape(text)}</p>",
        table=html_table,
        image=lambda name: embedded(folder, name),
    )
