"""Letters of pictures: none is cut or lies on another, and titles and axes say what is shown."""

import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv

pytest.importorskip("matplotlib")
pytest.importorskip("pygame")

from beamenv.rendering.canvas import HEIGHT, WIDTH, Canvas, Frame
from beamenv.rendering.charts import Chart, round_above, spread
from beamenv.rendering.titles import named_scenario, of_episode


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
