"""Speed: what it measures and how it judges."""

import gymnasium
import pytest

import beamenv
from train.cli.speed import show
from train.tools.speed import ROWS, TARGETS, batch_run, met, picture_run, single_run, speed


def test_steps_are_counted_over_the_time_they_take():
    env = gymnasium.make(beamenv.ENV_ID, duration=0.01)
    assert single_run(env, steps=50)() > 0.0
    assert batch_run(gymnasium.make_vec(beamenv.ENV_ID, num_envs=4), steps=40)() > 0.0


def test_pictures_are_counted_over_the_time_they_take():
    pytest.importorskip("pygame")
    assert picture_run(gymnasium.make(beamenv.ENV_ID, render_mode="rgb_array"), steps=3)() > 0.0


@pytest.mark.parametrize(
    ("name", "value", "verdict"),
    [
        ("batch_over_cartpole", 0.5, True),
        ("batch_over_cartpole", 0.3, False),
        ("single_over_cartpole", 0.4, False),
        ("pictures", 29.0, False),
        ("import_s", 0.2, True),
        ("assembly_ms", 70.0, False),
        ("cartpole", 1.0, None),
    ],
)
def test_rates_must_reach_their_target_and_times_stay_below(name, value, verdict):
    assert met(name, value) is verdict


def test_the_table_names_every_measurement_once(capsys):
    results = {name: 1.5 for name, _, _ in ROWS}
    assert set(TARGETS) <= set(results)
    show(results)
    printed = capsys.readouterr().out
    assert "CartPole-v1, gym.make" in printed
    assert "missed" in printed


@pytest.mark.slow
def test_every_row_is_measured():
    assert set(speed()) == {name for name, _, _ in ROWS}
