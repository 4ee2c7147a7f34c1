"""Commands on a model of one's own: `--plant FILE`."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from train.cli.app import app


@pytest.fixture(name="file")
def _file(tmp_path):
    path = tmp_path / "mine.npz"
    np.savez(path, A=[[0.0, 30.0], [-30.0, -0.6]], B=[[0.0], [1.0]], C=[[0.0, 1.0]], interval=0.02)
    return path


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def test_a_controller_is_evaluated_on_a_model(file):
    result = run("evaluate", "lqg", "--plant", file, "--seeds", 4, "--json")
    estimates = json.loads(result.stdout)["estimates"]
    assert result.exit_code == 0
    assert estimates["relative_cost"]["value"] < 0.5 and estimates["peak_tip"]["value"] is None


def test_a_benchmark_of_a_model_holds_the_model_in_its_configuration(file, tmp_path):
    chosen = ("--scenario", "nominal", "--controller", "lqg", "--seeds", 2, "--jobs", 1)
    result = run("benchmark", "--plant", file, *chosen, "--folder", tmp_path / "results")
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "results" / "configuration.json").read_text())
    np.testing.assert_array_equal(told["environment"]["plant"]["A"], [[0.0, 30.0], [-30.0, -0.6]])


def test_what_asks_for_a_rotor_is_refused_in_one_sentence(file):
    result = run("evaluate", "scheduled-lqg", "--plant", file, "--seeds", 2)
    assert result.exit_code == 2
    assert result.stderr.startswith("beamenv: plant is a model of one's own, but scheduled-lqg asks for a blade")
