"""What the pages hold: blocks, what is shown below them, commands, and commands within sentences."""

import re
import shlex
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```(?P<language>\w+)(?P<title>[^\n]*)\n(?P<body>.*?)^```$", flags=re.MULTILINE | re.DOTALL)
SPAN = re.compile(r"`((?:beamenv|make|python -m) [^`\n]+)`")
FENCE = re.compile(r"^```.*?^```$", flags=re.MULTILINE | re.DOTALL)


def pages():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]


def name_of(page):
    return str(page.relative_to(ROOT / "docs")) if page.is_relative_to(ROOT / "docs") else page.name


def blocks(page, *languages):
    """(line, language, text) of every fenced block in these languages, in the order of the page."""
    text = page.read_text(encoding="utf-8")
    return [(line_of(each, text), each["language"], each["body"]) for each in BLOCK.finditer(text) if each["language"] in languages]


def line_of(block, text):
    """The line of the page on which what is in a block begins."""
    return text.count("\n", 0, block.start("body")) + 1


def shown_below(page, *languages):
    """(line of a block in one of these languages, title, text) of what is shown directly below it: what it prints."""
    text = page.read_text(encoding="utf-8")
    for each, following in pairwise(BLOCK.finditer(text)):
        between = text[each.end() : following.start()]
        if each["language"] in languages and following["language"] == "text" and not between.strip():
            yield line_of(each, text), following["title"].strip(), following["body"]


def commands(text):
    """The words of every command in a shell block, comments left out."""
    lines = (shlex.split(line, comments=True) for line in text.replace("\\\n", " ").splitlines())
    return [words for words in lines if words]


def comments(text):
    """What stands behind ``#`` in a shell block."""
    return [line.partition("#")[2] for line in text.splitlines() if "#" in line]


def spans(page):
    """The words of every command that a sentence names; those with a place to be filled in, such as FILE, left out."""
    prose = FENCE.sub("", page.read_text(encoding="utf-8"))
    found = [span.rstrip("…. ") for span in SPAN.findall(prose)]
    return [shlex.split(span) for span in found if not re.search(r"[A-Z]{3}(?!=)|…|<", span)]
