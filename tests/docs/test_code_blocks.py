"""What the documentation says can be typed: Python blocks run page by page, commands have the options that they are given."""

import ast
import importlib.util
import re
from itertools import pairwise

import pytest

from tests.docs.printed import ELSEWHERE, assert_same_words
from tests.docs.running import outputs
from tests.docs.written import ROOT, blocks, commands, comments, name_of, pages, shown_below, spans

SLOW = {"agents.md", "libraries.md"}
"""Pages whose blocks take more than some ten seconds together."""


def with_blocks(language):
    return [page for page in pages() if blocks(page, language)]


def params(language, slow=frozenset()):
    marks = {page: [pytest.mark.slow] if page.name in slow else [] for page in with_blocks(language)}
    return [pytest.param(page, id=name_of(page), marks=those) for page, those in marks.items()]


@pytest.mark.parametrize("page", params("python", SLOW))
def test_blocks_run_in_the_order_of_their_page_and_print_what_it_shows(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown = {line: (title, text) for line, title, text in shown_below(page, "python", "sh")}
    for line, printed in outputs(page):
        title, text = shown.get(line, ("", ""))
        assert_same_words(printed, text, numbers=ELSEWHERE not in title)


@pytest.mark.parametrize("page", params("python"))
def test_python_blocks_can_be_pasted_at_the_prompt(page):
    """Where a loop or the like ends only with an empty line."""
    for line, _, text in blocks(page, "python"):
        body = ast.parse(text).body
        stuck = [
            after.lineno for before, after in pairwise(body) if hasattr(before, "body") and after.lineno == before.end_lineno + 1
        ]
        assert not stuck, line + stuck[0]


@pytest.fixture(name="known", scope="module")
def _known():
    """(the command line's commands, make's targets, the extras of the package)."""
    pytest.importorskip("typer")
    from typer.main import get_command

    from train.cli.app import app

    targets = re.findall(r"^([a-z][\w -]*):", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE)
    extras = (ROOT / "pyproject.toml").read_text(encoding="utf-8").partition("optional-dependencies]")[2].partition("\n[project")[0]
    return (
        get_command(app),
        {name for line in targets for name in line.split()},
        set(re.findall(r"^(\w+) = \[", extras, re.MULTILINE)),
    )


def check(words, known, named=False):
    """That a command exists and has these options; of one that is only ``named``, no more."""
    group, targets, extras = known
    program, *words = words
    if program == "beamenv" and words[0].startswith("-"):
        assert words[0] in ("--help", "--version"), words
    elif program == "beamenv":
        assert words[0] in group.commands, words
        command = group.commands[words[0]]
        if named:  # an option that a sentence names need not have its value, nor a command its arguments
            known_options = {option for each in command.params for option in each.opts}
            assert {word for word in words if word.startswith("--")} <= known_options, words
        else:
            command.make_context(words[0], words[1:])  # parses, and does not run
    elif program == "make":
        assert {word for word in words if "=" not in word} <= targets, words
    elif program == "pip":
        assert {name for word in words for names in re.findall(r"^\.\[(.*)\]", word) for name in names.split(",")} <= extras, words
    elif program == "python" and words[0] == "-m":
        assert importlib.util.find_spec(words[1]) is not None, words
    else:
        assert program in ("pip", "python", "git", "cd", "tensorboard"), program


@pytest.mark.parametrize("page", params("sh"))
def test_commands_exist_with_the_options_they_are_given(page, known):
    for _, _, text in blocks(page, "sh"):
        for words in commands(text):
            check(words, known)


@pytest.mark.parametrize("page", params("sh"))
def test_a_comment_beside_commands_holds_none_itself(page):
    """It would be tried by nobody: a command stands on a line of its own."""
    for _, _, text in blocks(page, "sh"):
        assert [comment for comment in comments(text) if re.search(r"\b(beamenv|make|pip|python) [a-z-]", comment)] == []


@pytest.mark.parametrize("page", [pytest.param(page, id=name_of(page)) for page in pages() if spans(page)])
def test_commands_within_sentences_exist_with_their_options(page, known):
    for words in spans(page):
        check(words, known, named=True)


def test_every_page_of_the_navigation_is_checked():
    with_python = {name_of(page) for page in with_blocks("python")}
    assert {name_of(page) for page in pages() if any(shown_below(page, "sh"))} <= with_python
    assert {"README.md", "quick-start.md", "physics.md", "lqg.md", "placement.md", "extending.md"} <= with_python
