"""What a benchmark is given, and what it refuses before it measures anything."""

import json
from pathlib import Path

import numpy as np
import pytest

import beamenv
from beamenv.scenarios.named import NAMES
from train.benchmark import benchmark
from train.benchmark.campaign import environment_json, read_scenarios


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"seeds": 1}, "seeds is 1, but must be a whole number from 2 to 1e[+]06"),
        ({"controllers": ["pid"]}, "controller is 'pid', but must be one of .*lqg, lqg-load"),
        ({"own": {"mine": 3}}, "controller 'mine' is of type int"),
        ({"own": {"lqg": np.zeros_like}}, "'lqg' is there twice"),
        ({"scenarios": []}, "scenarios is empty"),
        ({"scenarios": ["delay", "mine/delay.toml"]}, "scenarios delay and mine/delay.toml have the same name"),
    ],
)
def test_what_makes_no_sense_is_refused_at_once(arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        benchmark(**arguments)


@pytest.mark.parametrize("name", ["", " ", "a/b", "../mine", "a\\b", "a\nb"])
def test_names_that_no_file_can_have_are_refused(name, tmp_path):
    with pytest.raises(ValueError, match="^own is .*, but must be names that files can have"):
        benchmark({name: np.zeros_like}, scenarios=["nominal"], controllers=[], seeds=2, folder=tmp_path / "in")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("environment", "words"),
    [
        ({"colour": 1}, "environment has no field 'colour': its fields are preset, speed"),
        ({"scenario": "delay"}, "environment has no field 'scenario'"),
        ({"blade": {"speed": "x"}}, "blade.speed is 'x', but must be zero or a positive number"),
        ({"design": object()}, "design is <object object at .*, but must be one of thesis, "),
        ([1], "environment is .1., but must be a mapping"),
    ],
)
def test_an_environment_that_fails_in_every_cell_is_refused_at_once(environment, words):
    with pytest.raises(ValueError, match=f"^{words}"):
        benchmark(scenarios=["nominal"], controllers=[], seeds=2, environment=environment)


@pytest.mark.parametrize("kind", [str, Path])
def test_a_blade_in_a_file_goes_to_workers_as_what_the_file_says(kind, tmp_path):
    (tmp_path / "fast.toml").write_text("speed = 150.0\n")
    sent = environment_json({"blade": kind(tmp_path / "fast.toml")})
    assert sent == environment_json({"blade": beamenv.blade_config(overrides={"speed": 150.0})})


def test_numbers_of_numpy_and_whole_blades_are_the_same_environment():
    blade = beamenv.blade_config(overrides={"speed": 150.0, "voltage_limits": (-100.0, 100.0)})
    listed = {"speed": np.float32(150.0), "voltage_limits": np.array([-100.0, 100.0])}
    of = [environment_json({"blade": given}) for given in (blade, listed)]
    assert [beamenv.blade_config(overrides=json.loads(each)["blade"]) for each in of] == [blade, blade]


def test_groups_stand_for_their_scenarios_and_nothing_given_for_all_of_them():
    assert sorted(read_scenarios(None)[0]) == sorted(read_scenarios(["all"])[0]) == list(NAMES)
    assert tuple(read_scenarios(["open", "delay"])[0]) == (*beamenv.OPEN_SCENARIOS, "delay")


def test_a_file_called_like_a_group_is_a_scenario(tmp_path):
    (tmp_path / "open.toml").write_text('preset = "delay"\n')
    known, refused = read_scenarios([str(tmp_path / "open.toml"), "drift"])
    assert known["open"] == beamenv.scenario("delay") and set(known) == {"open", "drift"} and not refused
