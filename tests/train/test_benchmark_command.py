"""The command ``beamenv benchmark`` as a shell meets it."""

import json
import re

import numpy as np
import pytest
from typer.testing import CliRunner

from beamenv.plant.fingerprint import fingerprint
from beamenv.scenarios.named import GROUPS
from beamenv.task import resolve_task
from train.benchmark.table import BenchmarkTable, Row
from train.cli.app import app
from train.cli.benchmark_table import print_costs
from train.cli.quick import QUICK_LAWS, QUICK_RUNS, QUICK_SCENARIOS, QUICK_SEEDS
from train.controllers.named import named
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import save_policy

SMALL = ("benchmark", "--scenario", "deflection", "--controller", "lqg", "--episodes", "2", "--jobs", "1")


def run(*arguments):
    return CliRunner().invoke(app, list(arguments))


def test_json_alone_is_printed_and_the_documentation_written(tmp_path):
    result = run(*SMALL, "--folder", str(tmp_path / "results"), "--docs", str(tmp_path / "docs"), "--json")
    assert result.exit_code == 0, result.stderr
    content = json.loads(result.stdout)
    assert [row["controller"] for row in content["rows"]] == ["none", "lqg"]
    assert content["rows"][1]["estimates"]["relative_cost"]["value"] < 1.0
    text = (tmp_path / "docs" / "benchmark.md").read_text()
    assert "](images/benchmark.png)" in text
    assert f"numpy {content['configuration']['versions']['numpy']}" in text
    assert all((tmp_path / "docs" / "images" / name).is_file() for name in ("benchmark.png", "benchmark-dark.png"))
    assert "resumed" not in result.stderr
    again = run(*SMALL, "--folder", str(tmp_path / "results"), "--json")
    assert again.stdout == result.stdout
    assert "beamenv: resumed: all cells are kept from an earlier run." in again.stderr.splitlines()
    (tmp_path / "results" / "cells" / "deflection" / "lqg.json").unlink()
    again = run(*SMALL, "--folder", str(tmp_path / "results"), "--json")
    assert again.stdout == result.stdout
    assert "beamenv: resumed: 1 of 2 cells are kept from an earlier run." in again.stderr.splitlines()


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
        (("--episodes", "1"), "episodes"),
    ],
)
def test_bad_input_gets_one_sentence_and_status_2(arguments, named, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("benchmark", *arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert named in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_what_is_quick_is_a_dozen_rows_of_every_tier_in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = {}

    def measured(**arguments):
        asked.update(arguments)
        return benchmark(["none", "lqg"], ["deflection"])

    monkeypatch.setattr("train.cli.benchmark._measured", measured)
    result = run("benchmark", "--quick")
    assert result.exit_code == 0, result.output
    assert asked["folder"].as_posix() == "results/benchmark-quick"
    assert tuple(asked["scenarios"]) == QUICK_SCENARIOS and asked["seeds"] == QUICK_SEEDS < 128
    assert asked["runs"] == QUICK_RUNS == 2  # a single one has no spread
    assert {named(name).tier for name in QUICK_LAWS} == {0, 1, 2, 3} and set(QUICK_LAWS) <= set(asked["controllers"])
    assert set(QUICK_SCENARIOS) <= set(GROUPS["all"])
    assert re.search("2 episodes a cell: intervals are wide, ±[0-9]+ % of J / J₀", " ".join(result.stdout.split()))
    run("benchmark", "--quick", "--scenario", "open", "--episodes", "5", "--runs", "3")
    assert (asked["scenarios"], asked["seeds"], asked["runs"], asked["folder"].name) == (
        ["open"],
        5,
        3,
        "benchmark-quick-open-5-3-runs",
    )


def benchmark(controllers, scenarios, **others):
    from train.benchmark import benchmark as run

    return run(scenarios=scenarios, controllers=controllers, seeds=2, environment={"duration": 0.02}, **others)


def test_a_terminal_shows_as_many_scenarios_side_by_side_as_it_has_room_for(monkeypatch, capsys):
    names = ("nominal", "two-dead-actuators", "off-speed-failure", "delay")
    rows = [Row(name, law, law, "fixed", 0, 1, 2) for name in names for law in ("none", "positive-position-feedback")]
    table = BenchmarkTable(tuple(rows), {}, {})
    for width, times in ((120, 1), (80, 1), (60, 2), (20, 5)):
        monkeypatch.setenv("COLUMNS", str(width))
        print_costs(table)
        text = capsys.readouterr().out
        assert text.count("positive-position-feedback") == times
        assert max(map(len, text.splitlines())) <= max(width, 40)
        assert text.count("nominal") == text.count("actuators") == 1
        assert text.splitlines()[-1] == "✕ not measured."


def idle(folder, **about):
    """An agent that does nothing."""
    weights = {"weight0": np.zeros((4, 8), np.float32), "bias0": np.zeros(4, np.float32)}
    policy = HistoryPolicy("idle", weights, {"input_gain": 1.0, "held": 1}, -np.ones(4, np.float32), np.ones(4, np.float32))
    folder.mkdir(parents=True)
    save_policy(policy, folder, {"plants": {"nominal": fingerprint(resolve_task().design_plant)}, **about})


def test_the_folder_of_a_trained_agent_takes_part_by_the_folder_s_name(tmp_path):
    idle(tmp_path / "mine", tier=2)
    row = benchmark([str(tmp_path / "mine")], ["deflection"]).row("deflection", "mine")
    assert (row.kind, row.tier, row.runs) == ("learned", 2, 1)
    assert row.estimates["relative_cost"].value == pytest.approx(1.0, abs=1e-12)


def test_the_first_runs_of_an_agent_can_do_for_all_and_the_others_follow(tmp_path):
    for number in range(3):
        idle(tmp_path / "mine" / str(number))
    measured, told = (
        [],
        {"folder": tmp_path / "out", "progress": lambda done, total, cell: measured.append(cell.controller + cell.run)},
    )
    few = benchmark([str(tmp_path / "mine")], ["deflection"], runs=2, **told)
    assert measured == ["none", "lqg", "mine0", "mine1"] and few.row("deflection", "mine").runs == 2
    for runs, others in ((3, ["mine2"]), (None, [])):
        measured.clear()
        assert benchmark([str(tmp_path / "mine")], ["deflection"], runs=runs, **told).row("deflection", "mine").runs == 3
        assert measured == others
    with pytest.raises(ValueError, match="holds another benchmark, with controllers mine: name another folder"):
        benchmark([str(tmp_path / "mine")], ["deflection"], runs=2, **told)
