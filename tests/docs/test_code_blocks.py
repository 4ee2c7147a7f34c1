"""What the documentation says can be typed: Python blocks run page by page, commands have the options that they are given."""

import ast
import re
import shlex
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```(\w+)[^\n]*\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
SLOW = {"README.md", "agents.md"}
"""Pages whose blocks take more than some ten seconds together."""


def pages():
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def blocks(page, language):
    """(line, text) of every fenced block in a language."""
    text = page.read_text(encoding="utf-8")
    return [(text.count("\n", 0, each.start(2)) + 1, each[2]) for each in BLOCK.finditer(text) if each[1] == language]


def name_of(page):
    return str(page.relative_to(ROOT / "docs")) if page.is_relative_to(ROOT / "docs") else page.name


def with_blocks(language):
    chosen = [page for page in pages() if blocks(page, language)]
    return [
        pytest.param(page, id=name_of(page), marks=[pytest.mark.slow] if language == "python" and page.name in SLOW else [])
        for page in chosen
    ]


@pytest.mark.parametrize("page", with_blocks("python"))
def test_python_blocks_run_in_the_order_of_their_page_and_print_what_it_shows(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    namespace = {"__name__": page.stem}
    shown = dict(printed(page))
    for line, text in blocks(page, "python"):
        capsys.readouterr()
        exec(compile("\n" * (line - 1) + text, str(page), "exec"), namespace)  # tracebacks tell the page's own lines
        if line in shown:
            assert_same_words(capsys.readouterr().out, shown[line])


@pytest.mark.parametrize("page", [param.values[0] for param in with_blocks("python")], ids=name_of)
def test_python_blocks_can_be_pasted_at_the_prompt(page):
    """Where a loop or the like ends only with an empty line."""
    for line, text in blocks(page, "python"):
        body = ast.parse(text).body
        stuck = [
            after.lineno for before, after in pairwise(body) if hasattr(before, "body") and after.lineno == before.end_lineno + 1
        ]
        assert not stuck, line + stuck[0]


def printed(page):
    """(line of a Python block, text that it prints) of every block that is directly followed by one of what it prints."""
    text = page.read_text(encoding="utf-8")
    found = list(BLOCK.finditer(text))
    for each, following in pairwise(found):
        if each[1] == "python" and following[1] == "text" and not text[each.end() : following.start()].strip():
            yield text.count("\n", 0, each.start(2)) + 1, following[2]


def assert_same_words(printed, shown):
    """Word for word, numbers within 1 %: sums are another machine's."""
    number = re.compile(r"-?\d+\.\d+(?:e[-+]\d+)?")
    assert number.sub("#", printed).split() == number.sub("#", shown).split()
    values = [[float(each) for each in number.findall(text)] for text in (printed, shown)]
    assert values[0] == pytest.approx(values[1], rel=0.01)


def commands(page):
    """The words of every command in the shell blocks of a page, comments left out."""
    lines = (line for _, text in blocks(page, "sh") for line in text.replace("\\\n", " ").splitlines())
    return [words for words in (shlex.split(line, comments=True) for line in lines) if words]


@pytest.mark.parametrize("page", with_blocks("sh"))
def test_commands_exist_with_the_options_they_are_given(page):
    pytest.importorskip("typer")
    from typer.main import get_command

    from train.cli.app import app

    group = get_command(app)
    targets = set(re.findall(r"^([a-z][\w ]*):", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE))
    known = {name for line in targets for name in line.split()}
    for program, *words in commands(page):
        if program == "beamenv":
            assert words[0] in group.commands, words
            group.commands[words[0]].make_context(words[0], words[1:])  # parses, and does not run
        elif program == "make":
            assert {word for word in words if "=" not in word} <= known, words
        else:
            assert program in ("pip", "python", "git", "cd", "tensorboard"), program


def test_every_page_of_the_navigation_is_checked():
    with_python = {name_of(page) for page in pages() if blocks(page, "python")}
    assert {"README.md", "quick-start.md", "physics.md", "lqg.md", "placement.md", "extending.md"} <= with_python
