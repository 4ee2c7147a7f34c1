"""The leaderboard's page: its how-to runs, and it is that of its table."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from tests.train.entries import SMALL, rows
from train.benchmark import submission
from train.benchmark.leaderboard import NAME, PAGE, page, read_leaderboard
from train.cli.app import app


@pytest.fixture(autouse=True)
def small(monkeypatch, tmp_path):
    """In a folder of one's own."""
    monkeypatch.chdir(tmp_path)
    for name, value in SMALL.items():
        monkeypatch.setattr(submission, name, value)


@pytest.mark.slow
def test_the_how_to_of_the_page_runs(monkeypatch):
    """As it is typed, with two updates in place of a training, and agents as small as can be."""
    from train.learning import recipe

    text = page([])
    commands = text.split("```sh\n")[1].split("```")[0].splitlines()
    assert len(commands) < 15
    brief = recipe.parsed("agent = 'gradient'\ntitle = 'Brief'\nupdates = 1\n[settings]\nepisodes = 8\nwindow = 10\n", "brief")
    monkeypatch.setattr(recipe, "named_recipe", lambda name: brief)
    for line in commands:
        program, *words = line.split()
        assert program == "beamenv"
        if words[0] == "train":
            words = [word.replace("generalist", "nominal") for word in words]  # eleven banks of plants take a minute
        else:
            words += ["--jobs", "1"]
        result = CliRunner().invoke(app, words)
        assert result.exit_code == 0, result.output
    assert [row["name"] for row in rows()] == ["mine"]


def test_the_page_of_the_documentation_is_that_of_its_table():
    docs = Path(__file__).parents[2] / "docs"
    assert (docs / PAGE).read_text(encoding="utf-8") == page(read_leaderboard(docs / NAME))
