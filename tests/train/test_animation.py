"""The README's pictures: what moves, and sections."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pygame")
pytest.importorskip("PIL")

from PIL import Image

from beamenv.blade.files import load_config
from beamenv.rendering.canvas import Canvas
from train.tools.animation import MS_PER_PICTURE, STEPS_PER_PICTURE, write_animation
from train.tools.pair import COST, SCENES, SIZE, TIP, PairPicture
from train.tools.sections import NAMES, sections_figure

BLADES = Path(__file__).resolve().parents[2] / "examples" / "blades"

pyplot = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("pictures")
    write_animation(place, count=14)
    return place


def last(path):
    with Image.open(path) as moving:
        assert (moving.size, moving.n_frames) == (SIZE, 14)
        moving.seek(13)
        picture = np.asarray(moving.convert("RGB")).astype(int)
        assert moving.info["duration"] == MS_PER_PICTURE
    return picture


def part(picture, frame):
    return picture[int(frame.top) : int(frame.top + frame.height), int(frame.left) : int(frame.left + frame.width)]


def test_an_animation_shows_two_blades_that_differ_once_lqg_acts(folder):
    assert sorted(path.name for path in folder.iterdir()) == ["blade-dark.webp", "blade.webp"]
    alone, controlled = (part(last(folder / "blade.webp"), frame) for frame in SCENES)
    assert (np.abs(alone - controlled).max(axis=-1) > 60).sum() > 50


def test_the_dark_version_is_dark_and_shows_the_same(folder):
    light, dark = (last(folder / name) for name in ("blade.webp", "blade-dark.webp"))
    assert light[0, 0].mean() > 250.0 and dark[0, 0].mean() < 30.0
    assert np.corrcoef(part(light, SCENES[0]).std(axis=-1).ravel(), part(dark, SCENES[0]).std(axis=-1).ravel())[0, 1] > 0.5


def test_what_is_compared_is_in_one_chart_whose_axis_holds_both_and_never_changes(monkeypatch, tmp_path):
    drawn, told = [], []
    monkeypatch.setattr("train.tools.animation.PairPicture", lambda *a: drawn.append(PairPicture(*a)) or drawn[-1])
    write = Canvas.write
    monkeypatch.setattr(Canvas, "write", lambda canvas, text, *a, **k: told.append(text) or write(canvas, text, *a, **k))
    write_animation(tmp_path, count=4)
    pair = drawn[0]
    for chart, series in ((pair._cost, [h.costs for h in pair._histories]), (pair._tip, [h.tips[:, 1] for h in pair._histories])):
        factor = 1e3 if chart is pair._cost else 1e6
        assert chart.place in (COST.place, TIP.place)
        assert max(factor * np.abs(each).max() for each in series) <= chart.high
        assert len(series) == 2 and len(series[0]) == STEPS_PER_PICTURE * 3 + 1
    assert told.count(COST.title) == told.count(TIP.title) == 2  # once in each theme


def test_sections_are_drawn_with_one_legend_whose_letters_are_read_at_the_width_of_a_readme():
    figure = sections_figure({name: load_config(BLADES / f"{name}.toml") for name in NAMES})
    figure.canvas.draw()
    assert len(figure.axes) == 4
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["actuators", "sensors", "tension centre", "shear centre", "mass centre"]
    texts = [text for text in figure.findobj(pyplot.Text) if text.get_text().strip()]
    assert min(text.get_fontsize() for text in texts) >= 8.0  # at 100 dots an inch: 11 pixels
    for each in (*figure.axes, *figure.legends):
        box = each.get_tightbbox()
        assert box.x0 >= 0.0 and box.x1 <= figure.bbox.x1 and box.y0 >= 0.0 and box.y1 <= figure.bbox.y1
    pyplot.close(figure)
