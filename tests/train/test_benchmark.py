"""The benchmark in small: what it measures, keeps, refuses and writes."""

import csv
import json
import sys
from dataclasses import fields

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import evaluate, lqg, reference_lqg, stationary_cost
from beamenv.knowledge import Truth
from beamenv.plant.fingerprint import fingerprint
from train.benchmark import benchmark
from train.benchmark.listed import agents
from train.benchmark.targets import findings
from train.controllers import named as named_controllers
from train.controllers.named import NamedController, discover, named
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import save_policy
from train.shared.held_out import HELD_OUT

SHORT = {"duration": 0.02}
SMALL = {"scenarios": ["nominal", "spillover"], "controllers": ["lqg-load"], "seeds": 3, "environment": SHORT}

LIMITS = (-np.ones(4, np.float32), np.ones(4, np.float32))
IDLE = HistoryPolicy(
    "idle", {"weight0": np.zeros((4, 24), np.float32), "bias0": np.zeros(4, np.float32)}, {"input_gain": 1.0, "held": 1}, *LIMITS
)


class Notes:
    """Remembers the cells that were measured, and stops after some of them."""

    def __init__(self, stop=10**6):
        self.cells, self.stop = [], stop

    def __call__(self, done, total, cell):
        self.cells.append(f"{cell.scenario}/{cell.controller}")
        if len(self.cells) == self.stop:
            raise KeyboardInterrupt


class Still:
    """Any object with predict: no voltage."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros((len(observation), 4)), state


class Wild(Still):
    """Feeds whatever vibrates."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        instant = state or 0
        return np.full((len(observation), 4), 1.0 if instant % 40 < 20 else -1.0), instant + 1


class Broken(Still):
    """Fails."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        raise ZeroDivisionError("the weights sum to zero")


class Narrow(Still):
    """Has too few voltages."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        return np.zeros((len(observation), 2)), state


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("benchmark") / "small"
    return folder, benchmark(
        {"still": Still(), "function": np.zeros_like, "broken": Broken(), "narrow": Narrow()}, folder=folder, **SMALL
    )


def test_every_controller_meets_the_seeds_of_an_evaluation(finished):
    _, table = finished
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, scenario="spillover", dtype="float64", **SHORT)
    expected = evaluate(reference_lqg(envs.unwrapped.design.full_plant), envs, range(HELD_OUT, HELD_OUT + 3))
    row = table.row("spillover", "lqg")
    for name, estimate in expected.estimates().items():
        assert row.estimates[name].value == pytest.approx(estimate.value, rel=1e-12), name


def test_no_control_and_doing_nothing_cost_one_and_lqg_ties_with_itself(finished):
    _, table = finished
    for name in ("none", "still", "function"):
        relative = table.row("nominal", name).estimates["relative_cost"]
        assert (relative.value, relative.low, relative.high) == (1.0, 1.0, 1.0)
    itself = table.row("nominal", "lqg").estimates
    assert itself["difference_to_lqg"].value == 0.0
    assert itself["improvement_on_lqg"].value == 0.5


def test_what_fails_leaves_its_sentence_and_the_rest_goes_on(finished):
    _, table = finished
    assert table.row("nominal", "broken").sentences == ("ZeroDivisionError: the weights sum to zero",)
    assert "action has shape (3, 2), but must have shape (3, 4)" in table.row("spillover", "narrow").sentences[0]
    assert not table.row("nominal", "broken").measured
    assert table.row("spillover", "lqg-load").measured
    assert set(table.sentences) == {f"{name} in {where}" for name in ("broken", "narrow") for where in ("nominal", "spillover")}


def test_every_piece_is_written(finished):
    folder, table = finished
    written = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert {"table.csv", "table.md", "benchmark.json", "heat_map.png", "report.html", "cells/nominal/lqg.json"} <= written
    with (folder / "table.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["scenario"], row["controller"]) for row in rows] == [(row.scenario, row.controller) for row in table.rows]
    assert float(rows[0]["relative_cost"]) == table.rows[0].estimates["relative_cost"].value
    assert (folder / "heat_map.png").read_bytes().startswith(b"\x89PNG")
    text = (folder / "table.md").read_text()
    assert "| broken | 1 | own | failed | failed |" in text
    assert "- broken in nominal: ZeroDivisionError: the weights sum to zero" in text
    kept = json.loads((folder / "benchmark.json").read_text())
    assert {row["controller"]: row["tier"] for row in kept["rows"]} == {
        name: int(name not in ("none", "lqg", "lqg-load")) for name in table.controllers
    }
    assert [row["tier"] for row in rows] == [str(row.tier) for row in table.rows]
    assert kept["configuration"]["seeds"] == [HELD_OUT, HELD_OUT + 2]
    assert {"beamenv", "numpy", "Python"} <= set(kept["configuration"]["versions"])


def test_an_interrupted_run_goes_on_from_its_whole_cells(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        benchmark(folder=tmp_path, progress=Notes(stop=2), **SMALL)
    rest = Notes()
    table = benchmark(folder=tmp_path, progress=rest, **SMALL)
    assert rest.cells == ["nominal/lqg-load", "spillover/none", "spillover/lqg", "spillover/lqg-load"]
    again = Notes()
    assert [row.estimates for row in benchmark(folder=tmp_path, progress=again, **SMALL).rows] == [r.estimates for r in table.rows]
    assert again.cells == []


def test_cells_that_failed_and_objects_are_measured_again(tmp_path):
    one = {**SMALL, "scenarios": ["nominal"]}
    benchmark({"mine": Broken()}, folder=tmp_path, **one)
    notes = Notes()
    table = benchmark({"mine": Still()}, folder=tmp_path, progress=notes, **one)
    assert notes.cells == ["nominal/mine"]
    assert table.row("nominal", "mine").measured


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("[plants]\nspeeed_ratio = 1.0\n", "scenario.plants has no field 'speeed_ratio'"),
        ("[acquisition]\ndropout = 1.5\n", "acquisition.dropout is 1.5, but must be a number from 0 to 0.99"),
        ("step = [", "cannot be read"),
    ],
)
def test_a_scenario_file_that_is_wrong_is_refused_in_one_sentence(content, sentence, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(content)
    table = benchmark(**{**SMALL, "scenarios": [str(path), "nominal"]})
    assert sentence in table.refused[str(path)]
    assert table.scenarios == ("nominal",)
    with pytest.raises(ValueError, match="scenario"):
        benchmark(**{**SMALL, "scenarios": [str(path)]})


def test_a_scenario_file_is_a_scenario_of_its_name(tmp_path):
    path = tmp_path / "gusty.toml"
    path.write_text("[rotor]\nturbulence = 10.0\n")
    assert benchmark(**{**SMALL, "scenarios": [str(path)]}).scenarios == ("gusty",)


def test_a_file_in_the_folder_is_a_controller(tmp_path, monkeypatch):
    (tmp_path / "half_lqg.py").write_text(
        "from dataclasses import replace\nfrom baselines import lqg\nKIND = 'fixed'\nTIER = 0\n\n"
        "def build(design):\n    law = lqg(design.plant)\n    return replace(law, state_gain=0.5 * law.state_gain)\n"
    )
    monkeypatch.setattr(named_controllers, "__path__", [*named_controllers.__path__, str(tmp_path)])
    assert named("half-lqg").kind == "fixed"
    table = benchmark(**{**SMALL, "scenarios": ["nominal"], "controllers": ["half-lqg"]})
    assert table.row("nominal", "half-lqg").estimates["difference_to_lqg"].value != 0.0


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("KIND = 'fixed'\nTIER = 0\n", "has no build"),
        ("KIND = 'fixed'\nbuild = print\n", "has no TIER"),
        ("KIND = 'fuzzy'\nTIER = 0\nbuild = print\n", "wrong.KIND is 'fuzzy', but must be one of fixed"),
        ("KIND = 'fixed'\nTIER = 4\nbuild = print\n", "wrong.TIER is 4, but must be a whole number from 0 to 3"),
    ],
)
def test_a_controller_that_lacks_something_is_named(content, sentence, tmp_path, monkeypatch):
    (tmp_path / "wrong.py").write_text(content)
    monkeypatch.setattr(named_controllers, "__path__", [str(tmp_path)])
    sys.modules.pop("train.controllers.named.wrong", None)
    with pytest.raises(ValueError, match=sentence):
        discover()


class Unseen:
    """A task whose true blade may not be looked at."""

    def __init__(self, task):
        self._task = task

    def __getattr__(self, name):
        if name in ("plant", "config", "bank"):
            raise AssertionError(f"{name} of the true blade was read")
        return getattr(self._task, name)


@pytest.mark.parametrize("name", sorted(name for name, each in discover().items() if each.tier == 0))
def test_a_controller_is_built_without_a_look_at_the_true_blade(name):
    """Nor does another true blade behind the same design change what it does."""
    electronics = {"sensor_full_scale": 2e-5}
    blades = [electronics, {**electronics, "beam": {"pretwist_deg": 25.0}}]
    tasks = [gymnasium.make(beamenv.ENV_ID, blade=blade, design=electronics, **SHORT).unwrapped.task for blade in blades]
    assert tasks[0].plant.A.tobytes() != tasks[1].plant.A.tobytes()
    actions = []
    for task in tasks:
        law = named(name).build(type(task).design.fget(Unseen(task)))
        seen = {"state": np.full((2, len(task.design_plant.A)), 1e-3), "observation": np.full((2, 4), 0.1)}
        seen["observation and speed"] = np.hstack([seen["observation"], np.full((2, 1), 190.0)])
        actions.append(law.predict(seen[law.observes])[0])
    assert np.array_equal(*actions)
    assert name == "none" or np.abs(actions[0]).max() > 0.0


def test_a_controller_is_told_what_its_tier_knows():
    assert {name for name, each in discover().items() if each.tier == 3} >= {"lqg-truth", "lqr", "lqr-load"}
    task = gymnasium.make("beamenv/RotatingBeam-off-speed-v0", **SHORT).unwrapped.task
    for tier, kind in ((0, beamenv.Design), (1, beamenv.Prior), (2, beamenv.Prior), (3, Truth)):
        told = []
        NamedController("rival", "fixed", lambda known, told=told: told.append(known), tier).build_for(task)
        assert [type(each) for each in told] == [kind]


@pytest.mark.parametrize(("name", "least"), [("lqr", 3), ("scheduled-lqg", 2)])
def test_a_controller_that_sees_more_than_its_tier_is_refused(name, least):
    task = gymnasium.make(beamenv.ENV_ID, **SHORT).unwrapped.task
    law = named(name).build(task.told(least))
    with pytest.raises(ValueError, match=f"sly.TIER is {least - 1}, but must be at least {least} for what observes"):
        NamedController("sly", "fixed", lambda known: law, least - 1).build_for(task)


def test_lqg_that_is_told_the_truth_is_designed_for_it():
    task = gymnasium.make("beamenv/RotatingBeam-solid-20-v0", **SHORT).unwrapped.task
    law = named("lqg-truth").build_for(task)
    assert stationary_cost(task.plant, law) == stationary_cost(task.plant, lqg(task.plant))
    assert np.array_equal(named("lqg-sampled").build_for(task).transition, lqg(task.design_plant).transition)


def test_a_task_that_lets_nobody_see_its_true_blade_notices_who_looks():
    task = Unseen(gymnasium.make(beamenv.ENV_ID, **SHORT).unwrapped.task)
    with pytest.raises(AssertionError, match="plant of the true blade was read"):
        lqg(task.plant)
    assert {each.name for each in fields(beamenv.Design)} == {"plant", "config"}


def design_fingerprint(scenario):
    return fingerprint(gymnasium.make(beamenv.ENV_ID, scenario=scenario).unwrapped.design_plant)


def test_training_runs_are_pooled_and_specialists_stay_at_home(tmp_path):
    for run in ("generalist/0", "generalist/1", "nominal/0"):
        save_policy(IDLE, tmp_path / "ppo" / run, {"plants": {name: design_fingerprint(name) for name in SMALL["scenarios"]}})
    assert [each.name for each in agents(tmp_path)] == ["ppo-generalist", "ppo-specialist"]
    chosen = {**SMALL, "controllers": ["ppo-generalist", "ppo-specialist"]}
    table = benchmark(trained=tmp_path, **chosen)
    assert {(row.scenario, row.controller): row.runs for row in table.rows if row.kind == "learned"} == {
        ("nominal", "ppo-generalist"): 2,
        ("nominal", "ppo-specialist"): 1,
        ("spillover", "ppo-generalist"): 2,
    }
    sentences = [each.sentence for each in findings(table)]
    assert "is ahead of every law in 0 of 2 single fault scenarios, behind in " in sentences[0]
    within = "in 2 of 2 scenarios of a single fault (+0.0 % to +0.0 %)."  # of no control, the best law in so short an episode
    assert sentences[-1].startswith("ppo-generalist: within 3 %")
    assert sentences[-1].endswith(within)
    (tmp_path / "ppo" / "generalist" / "1" / "weights.npz").write_bytes(b"")
    row = benchmark(trained=tmp_path, **chosen).row("nominal", "ppo-generalist")
    assert row.runs == 1
    assert row.sentences[0] == "1 of 2 runs could not be measured:"


def test_an_agent_for_another_blade_is_told_in_one_sentence(tmp_path):
    save_policy(IDLE, tmp_path / "ppo" / "generalist" / "0", {"plants": {"elsewhere": "0" * 64}})
    row = benchmark(trained=tmp_path, **{**SMALL, "controllers": ["ppo-generalist"]}).row("nominal", "ppo-generalist")
    assert "is none of those the agent" in row.sentences[0]
    assert not row.measured


def test_episodes_that_a_controller_makes_twice_as_bad_count_as_unstable():
    table = benchmark({"wild": Wild()}, **{**SMALL, "scenarios": ["white"], "environment": {"duration": 0.1}})
    estimates = table.row("white", "wild").estimates
    assert estimates["relative_cost"].value > 2.0
    assert estimates["unstable"].value == 1.0


def test_where_nothing_moves_no_cost_is_relative_to_it():
    table = benchmark(**{**SMALL, "scenarios": ["quiet"]})
    assert "J without control is zero" in table.row("quiet", "lqg").sentences[0]


def test_blades_that_fail_are_judged_as_an_evaluation_does_also_from_kept_cells(tmp_path):
    path = tmp_path / "heavy.toml"
    path.write_text('preset = "step"\nmagnitude = 20000.0\n')
    heavy = {"scenarios": [str(path)], "controllers": [], "seeds": 2, "folder": tmp_path / "out", "environment": {"duration": 0.1}}
    for row in (*benchmark(**heavy).rows, *benchmark(**heavy).rows):
        found = {name: each.value for name, each in row.estimates.items()}
        assert (found["relative_cost"], found["relative_cost_iqm"], found["unstable"]) == (1.0, 1.0, 1.0), row.controller
        assert (found["settled"], found["settling_time"]) == (0.0, 0.1)
        assert (found["difference_to_lqg"], found["improvement_on_lqg"], found["cost"]) == (0.0, 0.5, np.inf)


def test_in_physical_units_the_named_laws_take_amperes_and_give_volts():
    arguments = {"scenarios": ["nominal"], "controllers": ["lqg"], "seeds": 2}
    plain, physical = (benchmark(**arguments, environment={**SHORT, "physical_units": each}) for each in (False, True))
    for row in plain.rows:
        same = physical.row("nominal", row.controller).estimates
        assert row.estimates["relative_cost"].value == pytest.approx(same["relative_cost"].value, rel=1e-9)


@pytest.mark.slow
def test_processes_side_by_side_give_the_same_numbers(finished, tmp_path):
    _, table = finished
    beside = benchmark(folder=tmp_path, jobs=2, **SMALL)
    for row in beside.rows:
        for name, estimate in table.row(row.scenario, row.controller).estimates.items():
            assert row.estimates[name].value == pytest.approx(estimate.value, rel=1e-9, abs=1e-12), name
