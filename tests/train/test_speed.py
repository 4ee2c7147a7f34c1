"""Speed: what it measures and how it judges."""

import gymnasium
import numpy as np
import pytest

import beamenv
from train.cli.speed import show
from train.speed.beside_cartpole import first_actions, ratios, speed, tensor_runs
from train.speed.rounds import batch_run, picture_run, single_run
from train.speed.rows import OVER_CARTPOLE, ROWS, TARGETS, met


def test_steps_are_counted_over_the_time_they_take():
    env = gymnasium.make(beamenv.ENV_ID, duration=0.01)
    assert single_run(env, steps=50)() > 0.0
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=4)
    assert batch_run(envs, first_actions(envs), steps=40)() > 0.0


def test_pictures_are_counted_over_the_time_they_take():
    pytest.importorskip("pygame")
    assert picture_run(gymnasium.make(beamenv.ENV_ID, render_mode="rgb_array"), steps=3)() > 0.0


@pytest.mark.parametrize(
    ("name", "value", "verdict"),
    [
        ("batch_4096_over_cartpole", 0.5, True),
        ("batch_4096_over_cartpole", 0.3, False),
        ("single_over_cartpole", 0.4, False),
        ("pictures", 29.0, False),
        ("import_s", 0.2, True),
        ("assembly_ms", 70.0, False),
        ("cartpole", 1.0, None),
    ],
)
def test_rates_must_reach_their_target_and_times_stay_below(name, value, verdict):
    assert met(name, value) is verdict


def test_the_table_names_every_measurement_once_and_targets_where_they_are_asked_for(capsys):
    results = {name: 1.5 for name, _, _ in ROWS} | {"threads": 1}
    assert set(TARGETS) <= set(results)
    show(results)
    printed = capsys.readouterr().out
    assert "CartPole-v1, gym.make" in printed
    assert "target" not in printed and "missed" not in printed
    show(results, check=True)
    assert capsys.readouterr().out.count("missed") == sum(met(name, 1.5) is False for name in TARGETS) > 0
    assert "threads of linear algebra: 1;" in printed and f"NumPy {np.__version__}" in printed


def test_without_torch_its_batch_is_told_to_need_it(capsys, monkeypatch):
    monkeypatch.setattr("train.speed.beside_cartpole.find_spec", lambda name: None)
    assert tensor_runs() == {}
    show({name: 1.5 for name, _, _ in ROWS if not name.startswith("tensors")} | {"threads": 1})
    assert capsys.readouterr().out.count("needs torch") == 2


def test_each_ratio_is_to_the_cartpole_of_its_kind():
    found = ratios({"cartpole": 2.0, "single": 1.0, "cartpole_4096": 10.0, "batch_4096": 4.0})
    assert found == {"single_over_cartpole": 0.5, "batch_4096_over_cartpole": 0.4}
    assert {f"{name}_over_cartpole" for name in OVER_CARTPOLE} <= {name for name, _, _ in ROWS}


@pytest.mark.slow
def test_every_row_is_measured():
    pytest.importorskip("torch")
    found = speed()
    assert set(found) == {"threads", *(name for name, _, _ in ROWS)}
    assert found["threads"] == 1
