"""Tables on a terminal: nothing is cut, none is wider than it, and an evaluation says what its benchmark's cell does."""

import json
import re

import gymnasium
import numpy as np
import pytest
import typer.main
from typer.testing import CliRunner

import beamenv
from baselines import evaluate, no_control
from train.benchmark import benchmark
from train.benchmark.runs import Runs
from train.cli.app import app
from train.cli.evaluations import show_compared, show_one
from train.cli.tables import Column, blocks, show_table, shown
from train.shared.held_out import held_out

COLUMNS = [Column("controller", words=True), Column("J / J₀"), Column("peak,\nV", wide=True), Column("RMS,\nV", wide=True)]
ROWS = [["a-controller-with-a-rather-long-name", "0.5", "10", "1"], ["none", "1.0", "0", "0"]]


def printed(monkeypatch, capsys, width, show, *arguments):
    monkeypatch.setenv("COLUMNS", str(width))
    show(*arguments)
    return capsys.readouterr().out


def test_further_columns_are_shown_from_120_on_and_told_below(monkeypatch, capsys):
    wide = printed(monkeypatch, capsys, 120, show_table, COLUMNS, ROWS)
    assert "RMS," in wide and "wider" not in wide
    for width in (80, 119):
        narrow = printed(monkeypatch, capsys, width, show_table, COLUMNS, ROWS)
        assert narrow.splitlines()[-1] == "A wider terminal shows besides: peak, V; RMS, V."
        assert "10" not in narrow


def test_of_the_further_columns_those_are_shown_that_fit():
    columns = [Column("a"), *(Column(str(k), wide=True) for k in range(3))]
    assert shown(columns, [60, 30, 28, 1], 124) == [0, 1, 2]  # 60 + 2 + 30 + 2 + 28 = 122, and 3 more do not fit
    assert shown(columns, [60, 30, 28, 1], 125) == [0, 1, 2, 3]
    assert shown(columns, [60, 30, 28, 1], 119) == [0]


def test_columns_that_do_not_fit_follow_beside_the_first_one_again(monkeypatch, capsys):
    assert list(blocks([10, 5, 5, 5], 24)) == [[0, 1, 2], [0, 3]]  # 10 + 2 + 5 + 2 + 5 = 24
    assert list(blocks([10, 5, 5, 5], 23)) == [[0, 1], [0, 2], [0, 3]]
    assert list(blocks([30, 30, 30], 1)) == [[0, 1], [0, 2]]
    columns = [Column("controller", words=True), Column("first"), Column("second")]
    text = printed(monkeypatch, capsys, 44, show_table, columns, [[ROWS[0][0], "1.25", "2.5"]], "Both")
    assert text.count(ROWS[0][0]) == 2 and "1.25" in text and "2.5" in text and "…" not in text
    assert max(map(len, text.splitlines())) <= 44


@pytest.fixture(scope="module")
def envs():
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=6, dtype="float64")


def idle(observation):
    return np.zeros((len(observation), 4))


def pushing(observation):
    return -0.6 * np.sign(observation)


def row_of(text, heading):
    line = next(line for line in text.splitlines() if line.startswith(heading))
    return re.split(r"  +", line.strip())[1:]


def test_a_controller_is_a_list_with_intervals_and_says_of_what_never_settles_that_it_takes_longer(envs, monkeypatch, capsys):
    evaluation = evaluate(idle, envs, range(6))
    text = printed(monkeypatch, capsys, 80, show_one, Runs("idle", {"": evaluation}), "scenario nominal")
    assert text.startswith("idle, scenario nominal")
    assert row_of(text, "J / J without control") == ["1.000", "1.000 to 1.000"]
    assert row_of(text, "settling time") == ["> 0.5"]
    assert row_of(text, "episodes that settle") == ["0 %", "0 % to 0 %"]
    assert row_of(text, "episodes that are unstable") == ["0 %", "0 % to 0 %"]
    assert "6 held-out episodes" in text
    assert "whole length" not in text and "unstable if" not in text and "reference" not in text  # nothing to be said of them
    assert max(map(len, text.splitlines())) <= 84


def test_the_unstable_share_is_that_of_the_benchmark_s_cell(monkeypatch, capsys):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=4, dtype="float64")
    evaluation = evaluate(pushing, envs, held_out(4))
    cell = benchmark({"pushing": pushing}, scenarios=["nominal"], controllers=["none"], seeds=4).row("nominal", "pushing")
    runs = Runs("pushing", {"": evaluation})
    assert runs.unstable == cell.estimates["unstable"] and runs.unstable.value > 0.0
    assert runs.one_to_dict()["estimates"]["unstable"]["value"] == runs.unstable.value
    text = printed(monkeypatch, capsys, 80, show_one, runs, "scenario nominal")
    assert row_of(text, "episodes that are unstable")[0] == f"{100 * runs.unstable.value:.0f} %"
    assert "An episode is unstable if the blade fails, or if J is more than 2 times" in text


def test_of_what_is_told_no_displacement_settling_is_not_known(tmp_path):
    plant = {"A": [[0.0, 1.0], [-100.0, -0.2]], "B": [[0.0], [1.0]], "C": [[0.0, 1.0]]}
    (tmp_path / "mine.json").write_text(json.dumps(plant))
    result = CliRunner().invoke(app, ["evaluate", "none", "--plant", str(tmp_path / "mine.json"), "--episodes", "2"])
    assert result.exit_code == 0, result.stderr
    assert row_of(result.stdout, "settling time") == row_of(result.stdout, "episodes that settle") == ["–"]


def test_controllers_are_compared_in_rows_whose_names_are_whole(envs, monkeypatch, capsys):
    first = evaluate(no_control(envs.unwrapped.design.full_plant), envs, range(6))
    other = evaluate(pushing, envs, range(6), reference=first.reference)
    for width in (80, 100, 140):
        text = printed(monkeypatch, capsys, width, show_compared, [other, first])
        table = [line for line in text[: text.index("6 held-out")].splitlines() if not line.startswith("A wider")]
        assert max(map(len, table)) <= width
        assert any(line.startswith("pushing ") for line in table)
        assert any("peak tip" in line for line in table) is (width == 140)


@pytest.mark.parametrize("words", ["frequencies", "section", "frequencies --preset airfoil-blade --speed 0 --speed 20 --speed 72"])
def test_tables_of_blades_and_what_is_said_of_them_are_no_wider_than_80_columns(words, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    result = CliRunner().invoke(app, words.split())
    lines = result.stdout.splitlines()
    assert len(lines) > 8 and max(map(len, lines)) <= 80


@pytest.mark.parametrize("words", [["--version"]])
def test_the_version_is_told(words):
    result = CliRunner().invoke(app, words)
    assert (result.exit_code, result.stdout) == (0, f"beamenv {beamenv.__version__}\n")


def test_paragraphs_of_help_break_where_the_terminal_ends(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    for name in ("explore", "place"):
        text = CliRunner().invoke(app, [name, "--help"]).stdout
        above = [line.strip() for line in text.partition("Options")[0].splitlines()]
        whole = [
            (line, after)
            for line, after in zip(above[:-1], above[1:], strict=True)
            if line and after and not line.startswith("Usage")
        ]
        assert all(len(line) + 1 + len(after.split()[0]) > 78 for line, after in whole if not after.startswith("╭")), name
        assert "…" not in text, name


FORMER = {"--seeds", "--save", "--passive", "--fresh"}


def test_one_thing_has_one_option_in_every_command():
    commands = typer.main.get_command(app).commands
    options = {name: {word for each in command.params for word in each.opts} for name, command in commands.items()}
    for name, words in options.items():
        assert not words & FORMER, name
        assert "--json" in words or name in ("schema", "explore"), name  # whose output is JSON, and whose results are a page
    written = {name for name, words in options.items() if "--folder" in words}
    assert written == {"compare", "reproduce", "benchmark", "train", "tune", "record", "identify"}
    assert {name for name, words in options.items() if "--output" in words} == {"export", "schema", "place"}
    asked = {name for name, words in options.items() if "--episodes" in words}
    assert asked == {"evaluate", "compare", "benchmark", "record"}
    assert all({"--preset", "--speed"} <= options[name] for name in ("train", "tune", "evaluate", "compare", "record", "export"))
