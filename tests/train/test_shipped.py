"""The trained policies that ship with the package, and how they are found."""

import json
from functools import lru_cache

import numpy as np
import pytest

from beamenv.task import resolve_task
from train.controllers.policies import HistoryPolicy
from train.controllers.policy_files import save_policy
from train.controllers.shipped import FOLDER, find_shipped, load_shipped, shipped
from train.controllers.sources import Trained

ONE = np.ones(4, np.float32)
POLICY = HistoryPolicy(
    "idle", {"weight0": np.zeros((4, 24), np.float32), "bias0": np.zeros(4, np.float32)}, {"input_gain": 1.0, "held": 1}, -ONE, ONE
)


@pytest.fixture
def shelf(tmp_path):
    for place in ("sac/nominal/3", "sac/nominal/1", "sac/overload/0", "ppo/generalist/0"):
        save_policy(POLICY, tmp_path / place)
    (tmp_path / "ppo/generalist/1").mkdir()  # without agent.json it is none
    return tmp_path


def test_they_are_found_by_agent_scenario_and_seed(shelf):
    found = [(each.agent, each.scenario, each.seed) for each in shipped(shelf)]
    assert found == [("ppo", "generalist", 0), ("sac", "nominal", 1), ("sac", "nominal", 3), ("sac", "overload", 0)]
    assert find_shipped("sac", "nominal", folder=shelf).seed == 1
    assert find_shipped("sac", "nominal", 3, shelf).folder == shelf / "sac/nominal/3"


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        (("tqc", "nominal"), "agent = 'tqc' must be one of those that ship with the package: ppo, sac"),
        (("ppo", "nominal"), "scenario = 'nominal' must be one that the agent 'ppo' ships for: generalist"),
        (("sac", "nominal", 2), "seed = 2 must be one that the agent 'sac' ships for in 'nominal': 1, 3"),
    ],
)
def test_what_there_is_is_told(shelf, asked, sentence):
    with pytest.raises(ValueError, match=sentence):
        find_shipped(*asked, folder=shelf)


def test_together_they_stay_below_5_mb():
    assert sum(path.stat().st_size for path in FOLDER.rglob("*") if path.is_file()) <= 5e6


@lru_cache
def task_of(scenario):
    return resolve_task(scenario=scenario)


@pytest.mark.parametrize("each", shipped(), ids=lambda each: f"{each.agent}-{each.scenario}-{each.seed}")
def test_each_tells_what_it_depends_on_and_acts_on_the_plants_it_was_trained_on(each):
    about = json.loads((each.folder / "agent.json").read_text())
    assert {"recipe", "seed", "scenario", "updates", "versions", "plants"} <= set(about)
    assert len((each.folder / "learning.csv").read_text().splitlines()) > 2
    for scenario in about["plants"]:
        policy = Trained(each.folder).build(task_of(scenario))
        action, _ = policy.predict(np.full((2, 4), 0.05, np.float32))
        assert np.isfinite(action).all()


TRAINED_ON_ANOTHER = (
    r"^plant is none of those the agent in .* was trained on, in delay, .*: beside that of nominal it has a first "
    r"natural frequency of 177\.5 rad/s in place of 186\.58, another full scale of its sensors"
)


def test_on_a_blade_that_it_was_not_trained_on_an_agent_is_refused_in_one_sentence():
    with pytest.raises(ValueError, match=TRAINED_ON_ANOTHER):
        load_shipped("residual", "generalist", 0, resolve_task(blade={"beam": {"length": 2.1}}).design_plant)
