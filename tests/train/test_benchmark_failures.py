"""Blades that fail, with control and without: which are saved, which are lost, and what they cost."""

import csv
import json
from dataclasses import replace

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import roll_out
from beamenv.scenarios.scenario import scenario
from train.benchmark import benchmark, failures
from train.benchmark.failures import Failures
from train.benchmark.showing.docs import page
from train.controllers.named import named
from train.shared.held_out import held_out

LONG = {"duration": 0.06}
SEEDS = 16
BAND = 10.0
"""N/m about the load that breaks the blade, which is some hundreds of times what the actuators hold."""

STILL = replace(scenario("overload"), direction_deg=(0.0, 0.0), onset=(0.0, 0.0), white_load=False, sensor_noise=False)
FILE = "step = 1.0\npulse = 0.0\ndeflection = 0.0\nharmonic = 0.0\nwhite_load = false\nsensor_noise = false\n"


class Wild:
    """Feeds whatever vibrates."""

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        instant = state or 0
        return np.full((len(observation), 4), 1.0 if instant % 40 < 20 else -1.0), instant + 1


def failed(controller, magnitude, blades):
    """(N,): whether a step of overload's kind breaks each blade."""
    envs = gymnasium.make_vec(
        beamenv.ENV_ID, num_envs=blades, scenario=replace(STILL, magnitude=magnitude), dtype="float64", **LONG
    )
    return roll_out(named(controller).build_for(envs.unwrapped.task), envs, held_out(blades)).failed


@pytest.fixture(scope="module")
def breaking():
    """N/m: the step that just breaks the blade without control, found by halving."""
    low, high = 3000.0, 4000.0
    assert not failed("none", (low, low), 1)[0] and failed("none", (high, high), 1)[0]
    while high - low > 2.0:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if failed("none", (middle, middle), 1)[0] else (middle, high)
    return high


@pytest.fixture(scope="module")
def judged(breaking, tmp_path_factory):
    """Overload's steps about that load: the blades that fail without control and under LQG, the folder, and the table."""
    folder = tmp_path_factory.mktemp("failures")
    about = (breaking - BAND, breaking + BAND)
    path = folder / "heavy.toml"
    path.write_text(f"{FILE}magnitude = {list(about)}\ndirection_deg = [0.0, 0.0]\nonset = [0.0, 0.0]\n")
    arguments = {"scenarios": [str(path)], "controllers": [], "seeds": SEEDS, "environment": LONG}
    table = benchmark({"wild": Wild()}, folder=folder / "out", **arguments)
    return failed("none", about, SEEDS), failed("lqg", about, SEEDS), folder / "out", table


def test_blades_that_only_stand_under_control_are_saved_and_those_that_only_fail_under_it_lost(judged):
    without, under_lqg, _, table = judged
    rows = {row.controller: row for row in table.rows}
    assert 0 < without.sum() < SEEDS
    assert rows["none"].failures == Failures(SEEDS, int(without.sum()), 0, 0)
    saved = int((without & ~under_lqg).sum())
    assert rows["lqg"].failures == Failures(SEEDS, int(without.sum()), saved, 0)
    assert saved > 0
    assert rows["wild"].failures.saved == 0 < rows["wild"].failures.lost


def test_a_blade_that_is_lost_costs_infinitely_and_one_that_fails_anyway_what_it_costs_without_control(judged):
    without, under_lqg, _, table = judged
    rows = {row.controller: row for row in table.rows}
    assert rows["wild"].estimates["relative_cost"].value == np.inf
    assert np.isinf(rows["wild"].cost[0]).sum() == rows["wild"].failures.lost
    anyway = without & under_lqg
    assert anyway.any()
    assert np.array_equal(rows["lqg"].cost[0][anyway], rows["lqg"].uncontrolled[anyway])
    assert (rows["lqg"].cost[0][~anyway] != rows["lqg"].uncontrolled[~anyway]).all()


def test_the_counts_are_in_every_file_and_the_rule_stands_once_on_the_page(judged):
    without, _, folder, table = judged
    rows = {row.controller: row for row in table.rows}
    kept = {row["controller"]: row for row in json.loads((folder / "benchmark.json").read_text())["rows"]}
    with (folder / "table.csv").open() as file:
        flat = {row["controller"]: row for row in csv.DictReader(file)}
    for name, row in rows.items():
        for count in ("fail_without", "saved", "lost"):
            assert kept[name][count] == int(flat[name][count]) == getattr(row.failures, count)
    text = page(table, "beamenv benchmark")
    assert text.count(failures.RULE) == 1
    assert f"Without control the blade fails in {without.sum()} of {SEEDS} episodes." in text
    assert f"| lqg | 0 | fixed | 1 | {rows['lqg'].failures.saved} | 0 |" in text
    assert failures.RULE[:60] in (folder / "report.html").read_text()


def test_runs_and_seeds_are_counted_together():
    cost = np.array([[1.0, np.inf, np.inf, 1.0], [np.inf, np.inf, 1.0, 1.0]])
    assert failures.failures(cost, np.array([1.0, 1.0, 0.0, 0.0])) == Failures(8, 4, 1, 1)
