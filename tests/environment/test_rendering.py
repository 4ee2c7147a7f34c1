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

from beamenv.rendering.canvas import HEIGHT, WIDTH, Canvas, Frame
from beamenv.rendering.charts import Chart, round_above, spread
from beamenv.rendering.history import History, Instant
from beamenv.rendering.palette import OUTPUT_SCALE, VOLTAGE_SCALE, colour_table, colours_of
from beamenv.rendering.scene import PLACE
from beamenv.rendering.titles import named_scenario, of_episode

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


def test_names_are_spread_near_where_their_curves_end():
    placed = spread(np.array([50.0, 49.0, 0.0, 300.0]), 0.0, 118.0, 11.0)
    assert np.diff(np.sort(placed)).min() >= 11.0 - 1e-9 and placed.min() >= 0.0 and placed.max() <= 118.0
    assert np.argsort(placed).tolist() == [2, 1, 0, 3]
    np.testing.assert_allclose(spread(np.array([10.0, 60.0]), 0.0, 118.0, 11.0), [10.0, 60.0])


def test_a_hyphen_is_a_minus_only_before_a_number():
    canvas = Canvas()
    assert canvas.width("-5", "label") == canvas.width("−5", "label") != canvas.width("‐5", "note")
    assert canvas.width("off-model", "label") < canvas.width("off−model", "label")


def test_letters_that_do_not_fit_are_left_out_and_that_is_seen():
    canvas = Canvas()
    short = canvas.fitted("a rather long title", "title", 60.0)
    assert short.endswith("…") and canvas.width(short, "title") <= 60.0
    assert canvas.fitted("short", "title", 60.0) == "short"
    lines = canvas.wrapped("one two three four five six seven eight nine ten", "note", 80.0, 2)
    assert len(lines) == 2 and lines[0].startswith("one two") and lines[1].endswith("…")
    assert max(canvas.width(line, "note") for line in lines) <= 80.0


def test_a_title_names_scenario_controller_and_seed():
    assert named_scenario(beamenv.SCENARIOS["off-model"]) == "scenario off-model"
    assert of_episode("LQG", 7, 1) == "LQG  ·  seed 7"
    assert of_episode("", 7, 3, blade=4) == "seed 7, episode 3, blade 5"
    assert of_episode("", 2**90, 2) == "episode 2"


def test_the_title_is_that_of_the_episode_under_way():
    env = RotatingBeamEnv(render_mode="rgb_array", scenario="quiet")
    env.controller = "LQG"
    for seed, whose in ((7, "LQG  ·  seed 7"), (None, "LQG  ·  seed 7, episode 2"), (3, "LQG  ·  seed 3")):
        env.reset(seed=seed)
        assert env._renderer.title == f"scenario quiet  ·  {whose}"
    envs = RotatingBeamVectorEnv(num_envs=3, render_mode="rgb_array", render_index=[2])
    envs.reset(seed=7)
    assert envs._pictures.renderers[2].title.endswith("seed 7, blade 3")
    envs.reset()
    assert envs._pictures.renderers[2].title.endswith("seed 7, episode 2, blade 3")


@pytest.mark.parametrize("name", ["a\nb\x00c", "\ud800", "é" * 5000, "", 7], ids=["ends", "half", "long", "none", "number"])
def test_any_name_of_a_controller_is_drawn(name):
    env = RotatingBeamEnv(render_mode="rgb_array", scenario="quiet", duration=0.01)
    env.controller = name
    env.reset(seed=0)
    assert env.render().shape == (HEIGHT, WIDTH, 3)


@pytest.fixture
def boxes(monkeypatch):
    """Left, top, right and bottom of every text that is written beside the blade; a new sheet begins anew."""
    found, write, clear = {}, Canvas.write, Canvas.clear

    def noted(canvas, text, x, y, colour, size, anchor=0.0):
        width = write(canvas, text, x, y, colour, size, anchor)
        if size != "number" and text:
            height = 9.0 if size in ("tick", "note") else 12.0  # of letters, without the space between lines
            found[text, round(x), round(y)] = (x - anchor * width, y - height / 2, x + (1 - anchor) * width, y + height / 2)
        return width

    monkeypatch.setattr(Canvas, "write", noted)
    monkeypatch.setattr(Canvas, "clear", lambda canvas: (found.clear(), clear(canvas)))
    return found


def check(found):
    for key, (left, top, right, bottom) in found.items():
        assert left >= 0.0 and top >= 0.0 and right <= WIDTH and bottom <= HEIGHT, key
    placed = list(found.items())
    for index, (key, one) in enumerate(placed):
        for other_key, other in placed[index + 1 :]:
            apart = one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]
            assert apart, (key, other_key)


@pytest.mark.parametrize(
    "arguments",
    [
        *({"preset": preset} for preset in sorted(beamenv.PRESETS)),
        {"scenario": {"preset": "unknown-everything", "plants": {"bank": 2}}},
        {"scenario": "overload"},
        {"plant": {"A": [[0.0, 1.0], [-400.0, -0.8]], "B": [[0.0], [1.0]], "C": [[1.0, 0.0]]}},
    ],
    ids=str,
)
def test_no_text_of_a_picture_is_cut_or_lies_on_another(arguments, boxes):
    env = RotatingBeamEnv(render_mode="rgb_array", **arguments)
    env.controller = "multiple-model-residual-generalist with a name that is far too long to be shown beside all the others"
    env.reset(seed=7)
    for _ in range(12):
        env.step(np.ones(env.action_space.shape))
    env.render()
    check(boxes)


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
