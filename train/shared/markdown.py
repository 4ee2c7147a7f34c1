"""Tables in Markdown, whatever stands in their cells, and what is folded."""

from __future__ import annotations

import html
import re
from collections.abc import Sequence

from train.shared.files import on_one_line

_ACTIVE = re.compile(
    r"[\\`|$]|~(?=~)|<(?=[A-Za-z/!?])|&(?=#|\w+;)|(?<=\])(?=[(\[])|!(?=\[)|:(?=//)|\*(?=[^*]*\*)|(?<=\*)\*|(?<!\w)_|_(?!\w)"
)
_ENTITIES = {"<": "&lt;", "&": "&amp;", ":": "&#58;", "$": "&#36;", "~": "&#126;"}


def escaped(text: str) -> str:
    """Text that Markdown shows as it stands, on one line: it ends no cell and becomes no code, HTML, emphasis, link or picture."""
    return _ACTIVE.sub(lambda found: _ENTITIES.get(found[0], f"\\{found[0]}"), on_one_line(text))


def table(headings: Sequence[str], rows: Sequence[Sequence[str]], words: int | None = None) -> str:
    """A table of plain text: the first ``words`` columns, all by default, left-aligned; the rest, numbers, on the right."""
    return markup_table([escaped(heading) for heading in headings], [[escaped(cell) for cell in row] for row in rows], words)


def markup_table(headings: Sequence[str], rows: Sequence[Sequence[str]], words: int | None = None) -> str:
    """The same of cells that are Markdown already."""
    left = len(headings) if words is None else words
    rule = ["---"] * left + ["---:"] * (len(headings) - left)
    return "\n".join("| " + " | ".join(line) + " |" for line in (headings, rule, *rows))


def folded(summary: str, body: str) -> str:
    """Markdown that a line of plain text, ``summary``, opens and closes."""
    return f"<details markdown>\n<summary>{html.escape(on_one_line(summary))}</summary>\n\n{body}\n\n</details>"
