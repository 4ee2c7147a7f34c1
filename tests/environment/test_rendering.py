"""Pictures: that they are drawn, and show what they say."""

import copy
import os
import pickle
import sys
import time

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import beamenv
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv

pytest.importorskip("matplotlib")
pytest.importorskip("pygame")

from beamenv.rendering.canvas import Frame
from beamenv.rendering.charts import Chart, round_above
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


def test_a_chart_widens_to_the_next_round_number_and_stays_there():
    chart = Chart("", Frame(0.0, 0.0, 1.0, 1.0), -100.0, 100.0)
    assert chart.reaching(99.0) is chart
    assert (chart.reaching(230.0).low, chart.reaching(230.0).high) == (-300.0, 300.0)
    assert chart.reaching(np.inf) is chart
    assert [round_above(value) for value in (0.07, 1.0, 3.5, 6.0)] == pytest.approx([0.1, 1.0, 5.0, 10.0])


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


def test_the_batch_draws_what_the_single_environment_draws():
    envs = RotatingBeamVectorEnv(num_envs=3, render_mode="rgb_array", render_index=[2, 0])
    envs.reset(seed=[5, 6, 7])
    single = RotatingBeamEnv(render_mode="rgb_array")
    single.reset(seed=7)
    for _ in range(4):
        envs.step(np.full((3, 4), 0.4))
        single.step(np.full(4, 0.4))
    pictures = envs.render()
    assert len(pictures) == 2
    np.testing.assert_array_equal(pictures[0], single.render())
    assert (pictures[1] != pictures[0]).any()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_the_batch_draws_the_start_of_the_next_episode(mode):
    envs = RotatingBeamVectorEnv(num_envs=2, duration=2e-3, autoreset_mode=mode, render_mode="rgb_array")
    envs.reset(seed=0)
    for _ in range(5 if mode == "NextStep" else 4):
        envs.step(np.zeros((2, 4)))
    history = envs._pictures.renderers[0]._history
    assert history.time == 0.0
    np.testing.assert_array_equal(history.last.state, envs.state[0])


@pytest.mark.parametrize("index", [3, -1, 0.5, "0", [], [0, 3]])
def test_a_blade_that_is_not_in_the_batch_cannot_be_drawn(index):
    with pytest.raises(ValueError, match="render_index is .* from 0 to 2"):
        RotatingBeamVectorEnv(num_envs=3, render_mode="rgb_array", render_index=index)


def test_a_batch_that_draws_nothing_makes_no_renderer_and_warns():
    envs = RotatingBeamVectorEnv(num_envs=2)
    envs.reset(seed=0)
    assert envs._pictures is None
    with pytest.warns(UserWarning, match="without a render_mode"):
        assert envs.render() is None


def test_rendering_without_a_mode_warns_and_draws_nothing():
    env = RotatingBeamEnv()
    env.reset(seed=0)
    with pytest.warns(UserWarning, match="without a render_mode"):
        assert env.render() is None


@pytest.fixture
def no_screen(monkeypatch):
    monkeypatch.setitem(os.environ, "SDL_VIDEODRIVER", "dummy")


def test_a_window_shows_every_step_at_the_stated_rate(no_screen):
    import pygame

    env = gymnasium.make(beamenv.ENV_ID, render_mode="human", duration=0.01)
    env.reset(seed=0)
    assert pygame.display.get_surface().get_size() == (960, 540)
    start = time.perf_counter()
    for _ in range(10):
        env.step(np.full(4, 0.5))
    assert time.perf_counter() - start >= 0.9 * 10 / env.metadata["render_fps"]
    shown = pygame.surfarray.array3d(pygame.display.get_surface()).transpose(1, 0, 2)
    np.testing.assert_array_equal(shown, env.unwrapped._renderer.draw())
    assert env.render() is None
    env.close()
    assert not pygame.display.get_init()


@pytest.mark.parametrize("library", ["matplotlib", "pygame"])
def test_pictures_without_a_library_say_what_to_install(library, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    sentence = rf'{library} is not installed, run `pip install "beamenv\[render\]"`'
    with pytest.raises(gymnasium.error.DependencyNotInstalled, match=sentence):
        RotatingBeamEnv(render_mode="rgb_array")
    with pytest.raises(gymnasium.error.DependencyNotInstalled, match=sentence):
        RotatingBeamVectorEnv(render_mode="rgb_array")


def test_gymnasium_s_video_wrappers_write_files(tmp_path):
    pytest.importorskip("moviepy")
    env = gymnasium.wrappers.RecordVideo(
        gymnasium.make(beamenv.ENV_ID, render_mode="rgb_array", duration=4e-3), str(tmp_path / "single"), disable_logger=True
    )
    envs = gymnasium.wrappers.vector.RecordVideo(
        RotatingBeamVectorEnv(num_envs=2, duration=4e-3, render_mode="rgb_array", render_index=range(2)), str(tmp_path / "batch")
    )
    for recorded, actions in ((env, np.zeros(4)), (envs, np.zeros((2, 4)))):
        recorded.reset(seed=0)
        for _ in range(8):
            recorded.step(actions)
        recorded.close()
    for folder in ("single", "batch"):
        files = list((tmp_path / folder).glob("*.mp4"))
        assert [file.stat().st_size > 1000 for file in files] == [True]
