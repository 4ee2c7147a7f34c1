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
    result = run("evaluate", "lqg", "--plant", file, "--episodes", 4, "--json")
    estimates = json.loads(result.stdout)["estimates"]
    assert result.exit_code == 0
    assert estimates["relative_cost"]["value"] < 0.5 and estimates["peak_tip"]["value"] is None


def test_a_benchmark_of_a_model_holds_the_model_in_its_configuration(file, tmp_path):
    chosen = ("--scenario", "nominal", "--controller", "lqg", "--episodes", 2, "--jobs", 1)
    result = run("benchmark", "--plant", file, *chosen, "--folder", tmp_path / "results")
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "results" / "configuration.json").read_text())
    np.testing.assert_array_equal(told["environment"]["plant"]["A"], [[0.0, 30.0], [-30.0, -0.6]])


@pytest.fixture(name="uneven")
def _uneven(tmp_path):
    """Two voltages and three sensors that feel them, one of them with another unit."""
    path = tmp_path / "uneven.npz"
    A = [[0.0, 30.0, 0.0], [-30.0, -0.6, 0.0], [0.0, 0.0, -60.0]]
    B = [[0.0, 0.0], [1.0, 0.3], [1.0, -0.9]]
    C = [[0.0, 1.0, 0.2], [0.3, 0.0, -0.8], [0.1, 0.5, 0.3]]
    np.savez(path, A=A, B=B, C=C, D=[[0.01, 0.0], [0.0, 0.01], [0.01, 0.01]], interval=0.02)
    return path


def test_a_benchmark_runs_what_can_be_had_of_a_model(uneven, tmp_path):
    result = run("benchmark", "--plant", uneven, "--quick", "--episodes", 2, "--jobs", 1, "--folder", tmp_path / "quick")
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "quick" / "benchmark.json").read_text())
    assert {row["controller"] for row in told["rows"]} >= {"none", "lqg", "lqg-load", "multiple-model", "clairvoyant"}
    assert all(row["estimates"] for row in told["rows"])
    page = (tmp_path / "quick" / "report.html").read_text(encoding="utf-8")
    assert "<h2>Readings and voltages</h2>" in page and 'id="blade"' not in page
    assert "What moves is a model with 3 states, 2 actuators and 3 sensors" in page


def test_scenarios_of_a_group_that_cannot_be_of_a_model_are_left_out_with_their_reason(uneven, tmp_path):
    chosen = ("--scenario", "open", "--controller", "lqg", "--episodes", 2, "--jobs", 1)
    result = run("benchmark", "--plant", uneven, *chosen, "--folder", tmp_path / "open")
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "open" / "benchmark.json").read_text())
    assert {row["scenario"] for row in told["rows"]} == {"mid-failure"}
    (sentence,) = told["left_out"]
    assert sentence.startswith("scenarios drift, gust-speed, unknown-everything left out: they are of the rotor, the plies,")
    assert f"beamenv: {sentence}" in result.stderr.splitlines()
    assert sentence in (tmp_path / "open" / "table.md").read_text()


@pytest.mark.parametrize(
    ("chosen", "words"),
    [
        (
            ("--scenario", "nominal", "--scenario", "spin-up"),
            "scenario 'spin-up' cannot be had of this plant: scenario.plants",
        ),
        (("--scenario", "rotor"), "scenario 'rotor' cannot be had of this plant: scenario.rotor.harmonics is"),
        (("--scenario", "nominal", "--controller", "velocity"), "plant has 2 actuators and 3 sensors, which velocity feedback"),
        (("--scenario", "nominal", "--controller", "scheduled-lqg"), "--plant is a model of one's own, but scheduled-lqg asks for"),
        (
            ("--scenario", "nominal", "--controller", "gradient-generalist"),
            "controller 'gradient-generalist' cannot be had of this plant: their training was on other plants.",
        ),
    ],
)
def test_what_is_asked_for_by_name_and_cannot_be_of_a_model_is_refused_before_any_work(chosen, words, uneven, tmp_path):
    result = run("benchmark", "--plant", uneven, *chosen, "--episodes", 2, "--folder", tmp_path / "none")
    assert result.exit_code == 2
    (line,) = result.stderr.splitlines()
    assert line.startswith(f"beamenv: {words}")
    assert not (tmp_path / "none").exists()


def test_a_scenario_that_breaks_more_than_a_model_has_is_left_out(file):
    from train.benchmark import benchmark

    table = benchmark(scenarios=["unseen"], controllers=["lqg"], seeds=2, environment={"plant": str(file)})
    assert "two-dead-actuators" not in table.scenarios and not table.sentences
    assert any("two-dead-actuators left out: scenario.failures.dead_actuators is 2, but" in each for each in table.left_out)


def test_laws_of_the_true_state_are_left_out_where_several_plants_move(uneven, tmp_path):
    from train.benchmark import benchmark

    (tmp_path / "mine" / "ensemble").mkdir(parents=True)
    content = dict(np.load(uneven))
    for name, factor in (("plant", 1.0), ("ensemble/000", 0.97), ("ensemble/001", 1.03)):
        np.savez(tmp_path / "mine" / f"{name}.npz", **{**content, "A": factor * content["A"]})
    names = ["none", "lqg", "lqr", "clairvoyant", "informed-lqg"]
    with pytest.raises(ValueError, match="^the true blade's state cannot be told in the design's coordinates: each of the plants"):
        benchmark(scenarios=["nominal"], controllers=names, seeds=2, environment={"plant": str(tmp_path / "mine")})
    names.remove("lqr")
    table = benchmark(scenarios=["nominal"], controllers=names, seeds=2, environment={"plant": str(tmp_path / "mine")})
    assert not table.sentences and all(table.row("nominal", name).measured for name in names)


def test_a_training_on_a_model_that_has_changed_is_not_resumed(file, tmp_path):
    words = ("train", "gradient", "--plant", file, "--updates", 1, "--looks", 0, "--folder", tmp_path / "agent")
    assert run(*words).exit_code == 0
    content = dict(np.load(file))
    assert run("evaluate", tmp_path / "agent", "--plant", file, "--episodes", 2).exit_code == 0
    moved = tmp_path / "elsewhere.npz"
    np.savez(moved, **content)  # where a file lies is not what it says
    assert run("train", "gradient", "--plant", moved, "--updates", 1, "--folder", tmp_path / "agent", "--resume").exit_code == 0
    np.savez(file, **{**content, "B": 1.1 * content["B"]})
    result = run(*words, "--resume")
    assert result.exit_code == 2
    assert "another training, of gradient in nominal with seed 0 (blade, speed or model differs): resume with" in result.stderr


def test_what_asks_for_a_rotor_is_refused_in_one_sentence(file):
    result = run("evaluate", "scheduled-lqg", "--plant", file, "--episodes", 2)
    assert result.exit_code == 2
    assert result.stderr.startswith("beamenv: --plant is a model of one's own, but scheduled-lqg asks for a blade")


def test_a_generalist_of_a_model_trains_on_the_scenarios_that_can_be_of_it(file):
    from train.learning.job import GENERALIST, Job
    from train.learning.recipe import named_recipe
    from train.learning.session import Budget

    tasks = Job("gradient", named_recipe("gradient"), GENERALIST, 0, Budget(updates=1), {"plant": str(file)}).tasks()
    assert set(tasks) == {"delay", "failure", "hysteresis", "nominal", "overload", "mid-failure"}


def test_frequencies_of_a_model_are_those_of_its_poles_with_their_dampings(file):
    told = json.loads(run("frequencies", "--plant", file, "--json").stdout)
    assert told["natural_frequencies"] == pytest.approx([30.0]) and told["damping_ratios"] == pytest.approx([0.01])
    shown = run("frequencies", "--plant", file)
    assert shown.exit_code == 0 and "30.00 (4.77)" in shown.stdout and "assumed: " in " ".join(shown.stdout.split())
    refused = run("frequencies", "--plant", file, "--speed", "20")
    assert refused.exit_code == 2 and refused.stderr.startswith("beamenv: --speed is 20.0, but must be left out with a plant")
