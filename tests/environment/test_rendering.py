"""Pictures: that they are drawn, and show what they say."""

import copy
import pickle

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import beamenv
from beamenv import RotatingBeamEnv

pytest.importorskip("matplotlib")
pytest.importorskip("pygame")

from beamenv.rendering.history import History, Instant
from beamenv.rendering.palette import OUTPUT_SCALE, VOLTAGE_SCALE, colour_table, colours_of
from beamenv.rendering.scene import PLACE

DEFLECTION = {"load": {"case": "deflection", "magnitude": 30.0, "direction_deg": 90.0}}


def drawn(**arguments):
    """An environment that draws, after a reset from a given deflection."""
    env = RotatingBeamEnv(render_mode="rgb_array", scenario="quiet", **arguments)
    env.reset(seed=0, options=DEFLECTION)
    return env


def scene_of(picture):
    rows = slice(int(PLACE.top), int(PLACE.top + PLACE.height))
    return picture[rows, int(PLACE.left) : int(PLACE.left + PLACE.width)].astype(int)


def patch_colour(env, picture, patch):
    """The commonest colour inside an actuator, which its outline and number do not hide."""
    scene = env._renderer._scene
    pose = scene.solid.pose(env._renderer._deformation.displacement(env.state, 0))
    left, top = scene._camera.project(pose.actuators[patch])[0].min(axis=0).astype(int)
    right, bottom = scene._camera.project(pose.actuators[patch])[0].max(axis=0).astype(int)
    near = picture[top : bottom + 1, left : right + 1].reshape(-1, 3)
    wanted = colours_of(colour_table(VOLTAGE_SCALE), env._renderer._history.last.volts / 1500.0)[patch]
    return int((np.abs(near.astype(int) - wanted).max(axis=1) <= 2).sum()), wanted


def test_a_picture_is_540_by_960_and_follows_the_blade():
    env = drawn()
    first = env.render()
    assert first.shape == (540, 960, 3)
    assert first.dtype == np.uint8
    np.testing.assert_array_equal(env.render(), first)
    assert np.ptp(first.reshape(-1, 3), axis=0).min() > 150
    for _ in range(25):  # half a period of the first mode in flap, about 26 ms
        env.step(np.zeros(4))
    second = env.render()
    assert (np.abs(scene_of(second) - scene_of(first)).max(axis=-1) > 30).sum() > 1000
    env.reset(seed=0, options=DEFLECTION)
    np.testing.assert_array_equal(env.render(), first)


def test_a_picture_that_was_given_away_does_not_change():
    env = drawn()
    first = env.render()
    kept = first.copy()
    env.step(np.full(4, 0.7))
    env.render()
    np.testing.assert_array_equal(first, kept)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_actuators_are_red_at_positive_and_blue_at_negative_voltage(sign):
    env = drawn()
    env.step(sign * np.array([0.2, 0.5, 0.8, 1.0]))
    picture = env.render()
    for patch in range(4):
        pixels, (red, _, blue) = patch_colour(env, picture, patch)
        assert pixels > 60
        assert sign * (red - blue) > 20


def test_sensors_are_orange_at_positive_and_violet_at_negative_output():
    red, _, blue = np.transpose(colours_of(colour_table(OUTPUT_SCALE), np.array([-0.5, 0.5])))
    assert blue[0] > red[0]
    assert red[1] > blue[1]


def test_history_keeps_the_last_fifth_of_a_second_and_the_whole_cost():
    history = History(interval=1e-3)
    for k in range(500):
        instant = Instant(np.zeros(2), 0, 200.0, np.full(2, float(k)), np.zeros(1), np.zeros(1), 0.5)
        history.record(instant) if k else history.begin(instant)
    assert history.time == pytest.approx(0.499)
    assert history.ages[[0, -1]] == pytest.approx([-0.2, 0.0])
    assert history.tips[[0, -1], 0].tolist() == [299.0, 499.0]
    assert history.costs[-1] == pytest.approx(0.5 * 499)


@pytest.mark.parametrize("preset", sorted(beamenv.PRESETS))
def test_every_preset_passes_gymnasium_s_checker_with_pictures(preset):
    env = gymnasium.make(beamenv.ENV_ID, preset=preset, render_mode="rgb_array", blade={"patches": {"ganged": True}})
    check_env(env.unwrapped)


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))], ids=["deepcopy", "pickle"])
def test_a_copied_environment_draws_on_alone(copied):
    env = drawn()
    for _ in range(5):
        env.step(np.full(4, 0.3))
    before = env.render()
    twin = copied(env)
    np.testing.assert_array_equal(twin.render(), before)
    env.step(np.full(4, -1.0))
    env.render()
    np.testing.assert_array_equal(twin.render(), before)


def test_a_blade_that_is_no_longer_finite_is_still_drawn():
    env = drawn()
    nowhere = np.full_like(env.state, np.nan)
    env._renderer.record(Instant(nowhere, 0, 200.0, nowhere[:2], np.zeros(4), np.zeros(4), np.nan))
    assert env.render().shape == (540, 960, 3)
