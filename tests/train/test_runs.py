"""Folders of several training runs: evaluated together, and the best of them taught from."""

import json
import shutil

import gymnasium
import numpy as np
import pytest
from typer.testing import CliRunner

import beamenv
from baselines import evaluate
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.fingerprint import fingerprint
from beamenv.task import resolve_task
from train.benchmark.runs import Runs
from train.cli.app import app
from train.cli.evaluations import show_one
from train.controllers.choice import chosen, chosen_runs
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import save_policy
from train.controllers.runs import best_run, runs_in
from train.learning.job import teacher_for

LIMITS = (-np.ones(4, np.float32), np.ones(4, np.float32))
GAINS = {"0": 0.0, "1": 0.02, "2": -0.02, "10": 0.04}


def agent(gain):
    weights = {"weight0": np.zeros((4, 24), np.float32), "bias0": np.full(4, gain, np.float32)}
    return HistoryPolicy(f"biased by {gain}", weights, {"input_gain": 1.0, "held": 1}, *LIMITS)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    home = tmp_path_factory.mktemp("agents") / "mine"
    plants = {"nominal": fingerprint(build_plant(blade_config()))}
    for run, gain in GAINS.items():
        save_policy(agent(gain), home / run, {"plants": plants})
        (home / run / "learning.csv").write_text(f"elapsed,steps,updates,cost\n1.0,10,1,0.1\n2.0,20,2,{1.0 - abs(gain - 0.02)}\n")
    (home / "tensorboard").mkdir()
    return home


def run(*arguments):
    return CliRunner().invoke(app, list(arguments))


def test_the_runs_of_a_folder_are_those_with_numbers_in_their_order(folder):
    assert list(runs_in(folder)) == ["0", "1", "2", "10"]
    assert dict(runs_in(folder / "1")) == {"": folder / "1"}
    assert dict(runs_in(folder / "nowhere")) == {"": folder / "nowhere"}


@pytest.fixture(scope="module")
def together(folder):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, duration=0.05)
    laws = chosen_runs(str(folder), envs.unwrapped.task, "nominal")
    return Runs("mine", {name: evaluate(law, envs, range(3)) for name, law in laws.items()})


def test_runs_have_a_mean_and_a_spread(together):
    content = together.to_dict()
    for estimate in ("relative_cost", "cost", "peak_tip", "effort"):
        values = np.array([each.estimates()[estimate].value for each in together.evaluations.values()])
        found, spread = content["estimates"][estimate], content["spread"][estimate]
        assert found["value"] == pytest.approx(values.mean(), rel=1e-12)
        assert found["low"] <= found["value"] <= found["high"]
        assert spread["deviation"] == pytest.approx(values.std(ddof=1), rel=1e-9)
        assert (spread["least"], spread["greatest"]) == (values.min(), values.max())
    assert content["spread"]["relative_cost"]["deviation"] > 0.0
    assert list(content["runs"]) == list(GAINS)
    assert {content["controller"], *(each["controller"] for each in content["runs"].values())} == {"mine"}


def test_a_screen_shows_the_runs_together_and_one_by_one(together, capsys):
    show_one(together, "scenario nominal")
    text = capsys.readouterr().out
    mean, deviation = together.estimates()["relative_cost"].value, together.spread()["relative_cost"].deviation
    first = next(line for line in text.splitlines() if line.startswith("J / J without control"))
    assert "mean of 4 runs" in text and f"{mean:.3f}" in first and first.endswith(f"{deviation:.3f}")
    rows = [line.split()[0] for line in text.splitlines() if line[:1].isdecimal()]
    assert rows[:4] == list(GAINS)


def test_the_command_evaluates_every_run_of_a_folder(folder, tmp_path):
    for name in ("0", "1"):
        shutil.copytree(folder / name, tmp_path / name)
    result = run("evaluate", str(tmp_path), "--episodes", "2", "--json")
    assert result.exit_code == 0, result.stderr
    content = json.loads(result.stdout)
    assert list(content["runs"]) == ["0", "1"]
    assert content["runs"]["0"]["estimates"]["relative_cost"]["value"] == 1.0
    mean = np.mean([each["estimates"]["relative_cost"]["value"] for each in content["runs"].values()])
    assert content["estimates"]["relative_cost"]["value"] == pytest.approx(mean, rel=1e-12)


def test_one_run_is_still_one_controller(folder):
    task = resolve_task()
    assert list(chosen_runs(str(folder / "2"), task, "nominal")) == [""]
    assert list(chosen_runs("lqg", task, "nominal")) == [""]
    with pytest.raises(ValueError, match="holds those of 4 runs, so name one of"):
        chosen(str(folder), task, "nominal")
    with pytest.raises(ValueError, match="trained_seed is 1, but must be left out"):
        chosen_runs(str(folder), task, "nominal", 1)


def trainings(home, *kinds):
    """Trainings by agent, scenario and seed, each with so many runs, as `beamenv train --folder` leaves several of them."""
    plants = {"nominal": fingerprint(build_plant(blade_config()))}
    for agent_name, scenario, seed, runs in kinds:
        own = home / f"{agent_name}-{scenario}-{seed}"
        for place in [own] if runs == 1 else [own / str(run) for run in range(runs)]:
            save_policy(agent(0.01 * seed), place, {"plants": plants, "agent": agent_name, "scenario": scenario})
    return home


def test_trainings_that_differ_in_their_seeds_alone_are_runs_of_one_agent(tmp_path):
    home = trainings(tmp_path / "mine", ("ppo", "nominal", 0, 1), ("ppo", "nominal", 7, 2))
    assert list(runs_in(home)) == ["ppo-nominal-0", "ppo-nominal-7-0", "ppo-nominal-7-1"]
    result = run("evaluate", str(home), "--episodes", "2", "--json")
    assert result.exit_code == 0, result.stderr
    content = json.loads(result.stdout)
    assert content["controller"] == "mine" and list(content["runs"]) == list(runs_in(home))
    assert content["spread"]["relative_cost"]["deviation"] > 0.0


def test_trainings_of_several_kinds_are_no_runs_of_one_agent(tmp_path):
    home = trainings(tmp_path / "mixed", ("ppo", "nominal", 0, 1), ("ppo", "delay", 0, 1), ("sac", "nominal", 0, 2))
    with pytest.raises(
        ValueError, match="holds trainings of several kinds, ppo-delay-0 of ppo on delay and .*: name one of them[.]"
    ):
        runs_in(home)
    result = run("evaluate", str(home))
    assert result.exit_code == 2 and len(result.stderr.splitlines()) == 1
    alone = trainings(tmp_path / "alone", ("ppo", "nominal", 0, 1))
    assert dict(runs_in(alone)) == {"": alone}


def test_the_run_that_ended_at_the_least_cost_teaches(folder, tmp_path):
    assert best_run(folder) == folder / "2"  # 1 − 0.04
    assert teacher_for(folder, {"nominal": resolve_task()}).name == "biased by -0.02"
    assert best_run(folder / "1") == folder / "1"
    for name, curve in (("0", None), ("1", "elapsed,steps,updates,cost\n1.0,1,1,nan\n"), ("2", "elapsed,steps,updates,cost\n")):
        save_policy(agent(0.0), tmp_path / name)
        if curve is not None:
            (tmp_path / name / "learning.csv").write_text(curve)
    assert best_run(tmp_path) == tmp_path / "0"
    (tmp_path / "2" / "learning.csv").write_text("nonsense\n")
    with pytest.raises(
        ValueError, match="^file .*learning.csv' has in line 1 'nonsense', but must have the columns elapsed,steps,"
    ):
        best_run(tmp_path)


def test_a_run_that_does_not_fit_is_named(folder, tmp_path):
    for name in ("0", "1"):
        save_policy(agent(0.0), tmp_path / name, {"plants": {"elsewhere": "0" * 64}})
    refused = run("evaluate", str(tmp_path), "--episodes", "2")
    assert refused.exit_code == 2
    assert "is none of those the agent in" in refused.stderr and len(refused.stderr.splitlines()) == 1


def test_the_readme_s_commands_are_taken():
    assert "several runs" in " ".join(run("evaluate", "--help").stdout.split())
