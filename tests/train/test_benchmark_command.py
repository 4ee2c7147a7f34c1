"""The command ``beamenv benchmark`` as a shell meets it."""

import json

import pytest
from typer.testing import CliRunner

from train.cli.app import app

SMALL = ("benchmark", "--scenario", "deflection", "--controller", "lqg", "--seeds", "2", "--jobs", "1")


def run(*arguments):
    return CliRunner().invoke(app, list(arguments))


def test_json_alone_is_printed_and_the_documentation_written(tmp_path):
    result = run(*SMALL, "--folder", str(tmp_path / "results"), "--docs", str(tmp_path / "docs"), "--json")
    assert result.exit_code == 0, result.stderr
    content = json.loads(result.stdout)
    assert [row["controller"] for row in content["rows"]] == ["none", "lqg"]
    assert content["rows"][1]["estimates"]["relative_cost"]["value"] < 1.0
    text = (tmp_path / "docs" / "benchmark.md").read_text()
    assert "![J over J without control](images/benchmark.png)" in text
    assert f"numpy {content['configuration']['versions']['numpy']}" in text
    assert (tmp_path / "docs" / "images" / "benchmark.png").is_file()


def test_what_could_not_be_served_is_told_and_the_rest_shown(tmp_path):
    (tmp_path / "mine.toml").write_text("stepp = 1.0\n")
    result = run(*SMALL, "--scenario", str(tmp_path / "mine.toml"), "--folder", str(tmp_path / "results"))
    assert result.exit_code == 1
    assert "scenario has no field 'stepp'" in result.stderr
    assert "Tier 0, the nominal plant: least J of 1 scenarios by lqg in 1, clearly in 1." in " ".join(result.stdout.split())


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--model", "mine.zip"), "can run any code when it is loaded"),
        (("--scenario", "storm"), "storm"),
        (("--controller", "pid"), "pid"),
        (("--seeds", "1"), "seeds"),
    ],
)
def test_bad_input_gets_one_sentence_and_status_2(arguments, named, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("benchmark", *arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert named in result.stderr
    assert list(tmp_path.iterdir()) == []
