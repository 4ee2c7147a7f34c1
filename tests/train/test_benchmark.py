"""A benchmark from its cells to its tables: what is measured, kept, resumed and judged."""

import csv
import json
import re

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import evaluate, reference_lqg
from tests.train.benchmarked import SHORT, SMALL, Broken, Narrow, Notes, Still, Wild
from train.benchmark import benchmark
from train.shared.held_out import HELD_OUT


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


def shown_on(page):
    """The controllers that readers choose among, by name."""
    return re.findall(r'<option value="\d+"(?: selected)?>(.*?):', page)


def test_the_page_leads_with_the_least_j_and_shows_everyone_who_was_measured(finished):
    folder, table = finished
    page = (folder / "report.html").read_text(encoding="utf-8")
    (lead,) = re.findall(r'<p class="lead">(.*?)</p>', page)
    ranked = sorted((row for row in table.within("nominal") if row.measured), key=lambda row: row.mean_cost)
    assert lead.startswith(f"In nominal, {ranked[0].controller} has the least J ")
    assert f"{ranked[0].estimates['relative_cost'].value:.3f}" in lead
    names = [row.controller for row in ranked if row.controller != "none"]
    assert {"lqg", "still", "function"} < set(names)
    assert shown_on(page) == ["no control", *names] * 2


class Crowded(Still):
    """Acts on several blades alone."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        if len(observation) < 3:
            raise RuntimeError("too few blades")
        return super().predict(observation, state, episode_start, deterministic)


def test_a_controller_that_cannot_be_shown_leaves_the_page_to_the_others(tmp_path):
    told = []
    benchmark(
        {"crowded": Crowded()}, folder=tmp_path, recording=lambda *each: told.append(each), **SMALL | {"scenarios": ["nominal"]}
    )
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Not shown, because they could not be run once more: crowded." in page
    assert set(shown_on(page)) == {"no control", "lqg", "lqg-load"}
    assert told[-3:] == [(0, 3, "no control"), (1, 3, told[-2][2]), (2, 3, told[-1][2])]


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
