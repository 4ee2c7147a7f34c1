"""``beamenv export``: a file, what is said of it, and what is refused."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from train.cli.app import app
from train.export.compiled import compiler


@pytest.fixture
def command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return lambda *words: CliRunner().invoke(app, ["export", *words])


def test_file_is_called_after_the_controller(command, tmp_path):
    result = command("lqg-load", "--precision", "single")
    assert result.exit_code == 0, result.output
    assert "written to lqg_load.c: lqg-load, in single precision, with 24 numbers to remember" in result.stdout
    content = (tmp_path / "lqg_load.c").read_text()
    assert "int lqg_load_step(lqg_load_state *state, const float sensors[4], float volts_out[4]);" in content
    assert "#define LQG_LOAD_INTERVAL 0.0005" in content and "double" not in content.partition("*/")[2]


def test_names_are_the_output_s_so_that_two_can_be_in_one_program(command, tmp_path):
    for file in ("boom.c", "tail.c"):
        assert command("lqg", "--output", file).exit_code == 0
        own = file.removesuffix(".c")
        assert f"void {own}_init({own}_state *state);" in (tmp_path / file).read_text()


def test_blade_and_name_are_those_asked_for(command, tmp_path):
    (tmp_path / "mine.toml").write_text("[patches]\nactuators = 2\nsensors = 3\n")
    result = command("lqg", "--blade", "mine.toml", "--name", "tail", "--output", "made/tail.c")
    assert result.exit_code == 0, result.output
    assert (
        "int tail_step(tail_state *state, const double sensors[3], double volts_out[2]);" in (tmp_path / "made/tail.c").read_text()
    )


def test_a_model_of_ones_own_is_what_it_is_designed_for(command, tmp_path):
    A, B, C = [[0.0, 1.0], [-400.0, -0.4]], [[0.0], [0.01]], [[0.0, 1.0]]
    np.savez(tmp_path / "mine.npz", A=A, B=B, C=C, interval=0.005)
    result = command("lqg", "--plant", "mine.npz")
    assert result.exit_code == 0, result.output
    content = (tmp_path / "lqg.c").read_text()
    assert "int lqg_step(lqg_state *state, const double sensors[1], double volts_out[1]);" in content
    assert "note:         lqg, plant mine.npz, scenario nominal" in content


@pytest.mark.skipif(compiler() is None, reason="there is no C compiler")
def test_step_time_is_told_beside_the_interval(command):
    assert "% of the control interval of 500 µs" in command("velocity", "--measure").stdout
    told = json.loads(command("velocity", "--measure", "--json", "--overwrite").stdout)
    assert 0.0 < told["seconds_a_step"] < 5e-4 and told["interval"] == "0.0005 s" and told["file"] == "velocity.c"


def test_a_file_that_is_there_is_kept_unless_it_is_to_be_replaced(command, tmp_path):
    (tmp_path / "lqg.c").write_text("mine")
    refused = command("lqg")
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert "output = 'lqg.c' is there already: overwrite it, or name another file." in refused.stderr
    assert (tmp_path / "lqg.c").read_text() == "mine"
    assert command("lqg", "--overwrite").exit_code == 0
    assert "int lqg_step" in (tmp_path / "lqg.c").read_text()


@pytest.mark.parametrize("form", ["mat", "onnx"])
def test_other_formats_are_written(command, tmp_path, form):
    if form == "onnx":
        pytest.importorskip("onnx")
    assert command("lqg", "--format", form).exit_code == 0
    assert (tmp_path / f"lqg.{form}").stat().st_size > 1000


def test_the_format_is_what_the_output_ends_in(command, tmp_path):
    assert command("lqg", "--output", "law.mat").exit_code == 0
    assert (tmp_path / "law.mat").read_bytes()[:6] == b"MATLAB"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("lqr",), "lqr (LinearController) cannot be exported: it observes the blade's true state"),
        (("mpc",), "it solves a quadratic program at every instant"),
        (("lqg", "--format", "ada"), "format is 'ada', but must be one of c, onnx, mat."),
        (
            ("lqg", "--format", "c", "--output", "law.mat"),
            "output is 'law.mat', but must be a file that ends in .c with the format 'c'.",
        ),
        (("lqg", "--precision", "half"), "precision is 'half', but must be one of double, single."),
        (("lqg", "--name", "int"), "name is 'int', but must be a letter, then letters, digits and underscores"),
        (("lqg", "--name", "a-b"), "name is 'a-b', but must be a letter, then letters, digits and underscores"),
        (("lqg", "--format", "mat", "--measure"), "measure is True, but must be left out with the format 'mat'"),
        (("lqj",), "(did you mean lqr or lqg"),
    ],
)
def test_what_is_refused_leaves_no_file(command, tmp_path, words, said):
    result = command(*words)
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert said in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_measuring_without_a_compiler_says_so(command, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("CC", "")
    result = command("lqg", "--measure")
    assert result.exit_code == 2 and "no C compiler is found" in result.stderr
    assert list(tmp_path.iterdir()) == []
