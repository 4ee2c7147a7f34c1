"""Figures: one vocabulary, which both renderers draw to the same effect."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from train.comparison.learning_curves import learning_curves
from train.figures import paper, paper_heat_map, screen, screen_heat_map
from train.figures.figure import Curve, Look, Marker, Note, Panel
from train.figures.heat_map import HeatMap
from train.figures.learning import learning_figure
from train.figures.palette import LINES, NEUTRAL, PALETTE, SIGNS, contrast
from train.figures.panels import LearningCurves, actuator, learning_panel, pole_panel, voltage_curves
from train.figures.patches import rows_of

pyplot = pytest.importorskip("matplotlib.pyplot", reason="matplotlib is not installed")
matplotlib = pytest.importorskip("matplotlib")
pytest.importorskip("matplotlib.offsetbox")
Image = pytest.importorskip("PIL.Image", reason="Pillow is not installed")
go = pytest.importorskip("plotly.graph_objects", reason="plotly is not installed")
colors = pytest.importorskip("plotly.colors", reason="plotly is not installed")

X = np.array([1.0, 2.0, 4.0])


@pytest.fixture
def axis():
    figure, axis = pyplot.subplots()
    yield axis
    pyplot.close(figure)


def both(axis, panel):
    """Matplotlib's axes and plotly's figure, which refuses a property that it does not know."""
    paper.draw_panel(axis, panel)
    return axis, go.Figure(screen.figure([panel]))


@pytest.mark.parametrize("line", [*LINES, "points"])
@pytest.mark.parametrize("fill", ["full", "none"])
def test_every_line_and_sign_is_drawn_on_paper_and_on_the_screen(axis, line, fill):
    signs = [sign for sign in paper.SIGNS if line == "points" or sign in SIGNS]
    curves = [Curve(X, X, sign, line, Look(PALETTE[0], marker=Marker(sign, fill=fill))) for sign in signs]
    drawn, shown = both(axis, Panel("", "x, m", "y, m", curves))
    for curve, one, other in zip(curves, drawn.lines, shown.data, strict=True):
        assert one.get_color() == PALETTE[0]
        assert (one.get_linestyle() == "None") == (other.mode == "markers") == (line == "points")
        np.testing.assert_array_equal(one.get_xdata(), other.x)
        assert (one.get_markerfacecolor() == "none") == (fill == "none")
        assert other.marker.symbol in (curve.label, f"{curve.label}-open", "circle", "circle-open")


@pytest.mark.parametrize(("joined", "drawstyle", "shape"), [("ends", "steps-pre", "vh"), ("begins", "steps-post", "hv")])
def test_a_held_value_is_a_step_on_both(axis, joined, drawstyle, shape):
    drawn, shown = both(axis, Panel("", "", "", [Curve(X, X, "held", joined=joined)]))
    assert (drawn.lines[0].get_drawstyle(), shown.data[0].line.shape) == (drawstyle, shape)


def test_labels_limits_scales_marks_and_notes_are_the_same_on_both(axis):
    panel = Panel(
        *("title", "time, ms", "tip, µm"),
        *([Curve(X, X, "tip")], True, (3.0,)),
        x_limits=(0.0, 5.0),
        y_limits=(None, None),
        notes=[Note(2.0, 2.0, "here")],
    )
    drawn, shown = both(axis, panel)
    assert (drawn.get_xlabel(), drawn.get_ylabel(), drawn.get_title()) == ("time, ms", "tip, µm", "title")
    assert (shown.layout.xaxis.title.text, shown.layout.yaxis.title.text) == ("time, ms", "tip, µm")
    assert drawn.get_xlim() == shown.layout.xaxis.range == (0.0, 5.0)
    assert drawn.get_yscale() == shown.layout.yaxis.type == "log"
    assert drawn.lines[0].get_xdata() == [3.0, 3.0] and shown.layout.shapes[0].x0 == 3.0
    assert [note.text for note in shown.layout.annotations] == ["title", "here"]
    assert [note.get_text() for note in drawn.texts] == ["here"]


def test_a_logarithmic_axis_of_everyday_numbers_writes_them_as_they_are(axis):
    curve = Curve(np.array([2.0, 300.0]), np.array([20.0, 150.0]))
    drawn, shown = both(axis, Panel("", "mass, g", "cost, µJ", [curve], logarithmic=True, x_logarithmic=True))
    drawn.figure.draw_without_rendering()
    (left, right), low_and_high = drawn.get_xlim(), drawn.get_ylim()
    x, y = ([text.get_text() for text in ticks] for ticks in (drawn.get_xticklabels(), drawn.get_yticklabels()))
    assert {"5", "10", "20", "50", "100", "200"} <= set(x) and {"20", "50", "100"} <= set(y)
    assert left < 2.0 and right > 300.0 and low_and_high[0] < 20.0
    assert shown.layout.xaxis.type == shown.layout.yaxis.type == "log"


def test_errors_of_many_decades_keep_their_powers_of_ten(axis):
    paper.draw_panel(axis, Panel("", "", "error", [Curve(X, np.array([1e-9, 1e-6, 1e-3]))], logarithmic=True))
    axis.figure.draw_without_rendering()
    assert any("10^{" in text.get_text() for text in axis.get_yticklabels())


def test_rows_have_names_in_place_of_numbers_on_both(axis):
    curves = [Curve(X, np.full(3, row), "actuators", "bars") for row in (1.0, 2.0)]
    drawn, shown = both(axis, Panel("", "", "", curves, y_names=("in turn", "at once")))
    assert [text.get_text() for text in drawn.get_yticklabels()] == list(shown.layout.yaxis.ticktext) == ["in turn", "at once"]
    assert drawn.get_yticks().tolist() == list(shown.layout.yaxis.tickvals) == [1, 2]
    assert (drawn.lines[0].get_solid_capstyle(), drawn.lines[0].get_linewidth()) == ("butt", paper.BAR)


def test_patches_that_touch_are_told_apart_and_no_longer_than_they_are():
    touching = [SimpleNamespace(start=0.0, length=0.08), SimpleNamespace(start=0.08, length=0.08)]
    actuators, sensors = rows_of(touching, touching[:1], 1, 2.0)
    assert 0.0 < actuators.x[0] < actuators.x[1] < 0.08 < actuators.x[3] < actuators.x[4] < 0.16
    assert np.isnan(actuators.x[2]) and actuators.y[0] > 1.0 > sensors.y[0]


def test_a_legend_has_one_entry_for_each_label(axis):
    curves = [Curve(X, X, "tip"), Curve(X, -X, "tip", listed=False), Curve(X, 0.0 * X), Curve(X, X, "other")]
    panel = Panel("", "", "", curves)
    _, shown = both(axis, panel)
    assert [handle.get_label() for handle in paper.handles([panel])] == ["tip", "other"]
    assert [trace.name for trace in shown.data if trace.showlegend] == ["tip", "other"]
    assert [trace.hoverinfo for trace in shown.data] == [None, None, "skip", None]


def test_panels_over_one_another_share_the_axis_of_the_last():
    panels = [Panel(f"panel {k}", "time, s" if k == 2 else "", "V", [Curve(X, X, "volts")]) for k in range(3)]
    figure = go.Figure(screen.figure(panels))
    assert [trace.yaxis for trace in figure.data] == ["y", "y2", "y3"]
    assert figure.layout.xaxis.title.text == "time, s"
    assert figure.layout.grid.rows == 3
    assert [note.yref for note in figure.layout.annotations] == ["y domain", "y2 domain", "y3 domain"]


def test_compact_numbers_are_five_digits_at_even_intervals():
    time = np.linspace(0.0, 1.0, 5)
    (trace,) = screen.figure([Panel("", "", "", [Curve(time, 1e-3 * np.pi * time, "tip")])], compact=True)["data"]
    assert (trace["x0"], trace["dx"]) == (0.0, 0.25)
    assert trace["y"] == [0.0, 0.0007854, 0.0015708, 0.0023562, 0.0031416]


def test_the_real_axis_of_poles_is_odd_linear_near_zero_and_logarithmic_far_out():
    assert screen.symmetric_logarithm(np.array([-90.0, 0.0, 90.0]), 10.0).tolist() == [-1.0, 0.0, 1.0]
    near = screen.symmetric_logarithm(np.array([1e-3]), 10.0)
    assert near[0] == pytest.approx(1e-3 / (10.0 * np.log(10.0)), rel=1e-3)


def test_an_unstable_pole_lies_right_of_the_imaginary_axis_on_both(axis):
    panel = pole_panel({"no control": np.array([-1.0 + 5.0j]), "loop": np.array([-5.0 + 100.0j, -5.0 - 100.0j, 2.0 + 0.0j])})
    drawn, shown = both(axis, panel)
    imaginary = shown.layout.shapes[0].x0
    assert imaginary == drawn.lines[0].get_xdata()[0] == 0.0
    assert np.asarray(shown.data[1].customdata).tolist() == drawn.lines[2].get_xdata().tolist() == [-5.0, 2.0]
    assert shown.data[1].x[0] < imaginary < shown.data[1].x[1]
    assert (shown.data[0].marker.color, shown.data[1].marker.color) == (NEUTRAL, PALETTE[0])


def test_actuators_are_told_apart_by_line_as_well_as_by_colour():
    curves = voltage_curves(X, np.zeros((3, 6)))
    assert len({curve.look.colour for curve in curves}) == 6
    assert [curve.line for curve in curves] == ["solid", "dashed", "dotted", "dashdot", "solid", "dashed"]
    assert actuator(1) == (curves[1].look, curves[1].line)


def test_a_learning_curve_has_its_steps_and_levels_their_number():
    told = np.array([[1.0, 1e5, 1.4], [2.0, 2e5, 0.9], [3.0, 3e5, 0.6]])
    panel = learning_panel(LearningCurves({"PPO": told, "silent": np.empty((0, 3))}, {"LQG": 0.4}))
    assert [curve.label for curve in panel.curves] == ["PPO (0.3 million steps)", "silent", "LQG: 0.400"]
    assert panel.x_limits == (0.0, 3.0)
    assert panel.y_limits == (0.0, 1.05)


def test_nothing_that_is_learnt_or_compared_lies_below_the_figure_and_all_lines_differ():
    time = np.linspace(1.0, 10.0, 5)
    curves = {name: np.stack([time, 1e5 * time, low + 1.0 / time], axis=-1) for name, low in (("belief", 0.1), ("ppo", 0.2))}
    figure = learning_figure(curves, {"LQG": 0.15, "LQG with load estimate": 0.12})
    (axis,) = figure.axes
    assert axis.get_ylim()[0] <= 0.12 and "validation episodes, lower is better" in axis.get_ylabel()
    assert len({str(line.get_linestyle()) + str(line._dash_pattern) for line in axis.lines}) == 4
    pyplot.close(figure)


def test_learning_curves_of_shipped_agents_name_their_axis_once_a_row_and_each_curve_at_its_end():
    curves = [Curve(X, X / 4.0, "LQG"), *(Curve(X, X / (4.0 + 0.01 * k), f"seed {k}", LINES[k]) for k in range(4))]
    panels = [Panel(f"ppo, {k}", "million intervals", "" if k % 2 else "J / J of LQG", curves) for k in range(3)]
    figure = learning_curves(panels, "dark")
    assert [axis.get_ylabel() for axis in figure.axes[:3]] == ["J / J of LQG", "", "J / J of LQG"]
    assert "lower is better" in figure.get_suptitle()
    figure.canvas.draw()
    held = [each for each in figure.axes[0].artists if isinstance(each, matplotlib.offsetbox.AnnotationBbox)]
    names = [each.findobj(matplotlib.text.Text)[0].get_text() for each in held]
    boxes = [each.get_window_extent() for each in held]
    assert names == ["LQG", *(f"seed {k}" for k in range(4))]
    assert all(figure.axes[0].bbox.x1 < box.x0 and box.x1 < figure.axes[1].get_tightbbox().x0 for box in boxes)
    assert not any(box.overlaps(other) for index, box in enumerate(boxes) for other in boxes[index + 1 :])
    pyplot.close(figure)


MISSING = HeatMap(
    ("step", "pulse"),
    ("LQG", "PPO", "SAC"),
    np.array([[0.4, np.inf, 0.5], [0.6, np.nan, np.nan]]),
    np.array([[0.0, 0.002, 0.0], [0.0, np.nan, np.nan]]),
    kinds=("fixed", "learned", "learned"),
    best=("LQG", "LQG"),
    lost=frozenset({("pulse", "PPO")}),
)


def test_a_heat_map_on_paper_writes_costs_instability_and_what_is_missing():
    figure = paper_heat_map.heat_map(MISSING)
    cells = {tuple(text.get_position()): text for text in figure.axes[0].texts}
    written = {(round(y), x): text.get_text() for (x, y), text in cells.items() if y < 1.5 and "▲" not in text.get_text()}
    assert written == {(0, 0): "0.40", (0, 1): "∞", (0, 2): "0.50", (1, 0): "0.60", (1, 1): "✕", (1, 2): "–"}
    assert [text.get_text() for text in cells.values() if "▲" in text.get_text()] == ["▲ < 1 %"]
    assert [cells[0, 0].get_weight(), cells[2, 0].get_weight()] == ["bold", "normal"]
    assert {text.get_text() for (_, y), text in cells.items() if y > 1.5} == {"fixed", "learned"}
    assert {"J / J without control", "lower is better"} <= {text.get_text() for text in figure.texts}
    pyplot.close(figure)


def test_a_heat_map_has_the_same_shades_and_signs_on_paper_and_on_the_screen():
    figure = paper_heat_map.heat_map(MISSING)
    image, written = figure.axes[0].images[0], [text.get_text() for text in figure.axes[0].texts]
    cells, missing = go.Figure(screen_heat_map.heat_map(MISSING)).data
    assert [shade for _, shade in cells.colorscale] == [shade for _, shade in colors.get_colorscale("cividis_r")]
    for place in ((0, 0), (0, 1), (0, 2), (1, 0)):
        height = (cells.z[place[0]][place[1]] - cells.zmin) / (cells.zmax - cells.zmin)
        (shade,) = colors.sample_colorscale("cividis_r", [height], colortype="tuple")
        np.testing.assert_allclose(shade, image.to_rgba(image.get_array())[place][:3], atol=0.02)
        ink = re.match(r'<span style="color:(#[0-9a-f]{6})">', cells.text[place[0]][place[1]])[1]
        assert contrast(ink, matplotlib.colors.to_hex(shade)) >= 4.5  # WCAG 2.1 (1.4.3)
    signs = [re.sub("</?(span|b)( [^>]*)?>", "", sign) for row in cells.text for text in row for sign in text.split("<br>") if sign]
    assert set(signs) | set(missing.text) == set(written) - {"fixed", "learned"}
    assert "<b>0.40</b>" in cells.text[0][0]
    pyplot.close(figure)


@pytest.mark.parametrize("theme", paper.THEMES)
def test_numbers_of_a_heat_map_are_legible_on_every_shade_and_its_names_on_the_paper(theme):
    cost = np.geomspace(0.3, 3.0, 40)[None]
    content = HeatMap(("step",), tuple(map(str, range(40))), cost, np.zeros((1, 40)))
    figure = paper_heat_map.heat_map(content, theme)
    shades = figure.axes[0].images[0].to_rgba(np.clip(cost[0], 0.35, 2.0))
    for text, shade in zip(figure.axes[0].texts, shades, strict=True):
        assert contrast(text.get_color(), matplotlib.colors.to_hex(shade)) >= 4.5  # WCAG 2.1 (1.4.3)
    names = figure.axes[0].get_xticklabels()
    assert contrast(matplotlib.colors.to_hex(names[0].get_color()), matplotlib.colors.to_hex(figure.get_facecolor())) >= 7.0
    pyplot.close(figure)


def test_no_text_of_a_full_heat_map_is_cut_or_lies_on_another():
    names = [f"multiple-model-residual-law-{k}" for k in range(9)]
    scenarios = tuple(f"unknown-everything-{k}" for k in range(12))
    cost, failed = np.linspace(0.3, 30.0, 108).reshape(12, 9), np.full((12, 9), 0.005)
    content = HeatMap(scenarios, tuple(names), cost, failed, ("tier 0",) * 9, groups=("single fault",) * 6 + ("unseen",) * 6)
    figure = paper_heat_map.heat_map(content)
    figure.canvas.draw()
    texts = [text for text in figure.findobj(matplotlib.text.Text) if text.get_text().strip() and text.get_visible()]
    level = [text.get_window_extent() for text in texts if text.get_rotation() == 0.0]
    assert len(level) > 200
    for index, box in enumerate(level):
        assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1 and figure.bbox.y0 <= box.y0 and box.y1 <= figure.bbox.y1
        assert not any(box.shrunk(0.98, 0.7).overlaps(other.shrunk(0.98, 0.7)) for other in level[index + 1 :])
    pyplot.close(figure)


def test_a_picture_of_both_themes_is_two_files_that_differ_in_their_paper(tmp_path):
    def drawn(theme):
        with paper.styled(theme):
            figure, axis = pyplot.subplots(figsize=(1.0, 0.5))
            paper.draw_panel(axis, Panel("", "", "", [Curve(X, X, "tip")]))
        return figure

    paper.save_themes(drawn, tmp_path / "tip.png")
    papers = [Image.open(tmp_path / name).convert("RGB").getpixel((0, 0)) for name in ("tip.png", "tip-dark.png")]
    assert papers == [(255, 255, 255), (13, 17, 23)]


def test_a_heat_map_has_a_panel_for_each_group_of_scenarios():
    names, groups = tuple(f"scenario {line}" for line in range(23)), ("single fault",) * 10 + ("open",) * 4 + ("unseen",) * 9
    cost = np.linspace(0.3, 30.0, 23 * 9).reshape(23, 9)
    figure = paper_heat_map.heat_map(HeatMap(names, tuple(f"law {k}" for k in range(9)), cost, np.zeros((23, 9)), groups=groups))
    panels = figure.axes[:3]
    assert [axis.get_ylabel() for axis in panels] == ["single fault", "open", "unseen"]
    assert [[text.get_text() for text in axis.get_yticklabels()] for axis in panels] == [
        [*names[:10]],
        [*names[10:14]],
        [*names[14:]],
    ]
    assert [len(axis.get_xticklabels()) for axis in panels] == [9, 0, 0]
    assert [panels[2].texts[-1].get_text(), panels[0].texts[0].get_text()] == ["30", "0.30"]
    assert figure.get_size_inches()[0] < 8.5  # at the width of a page its numbers are to be read
    pyplot.close(figure)


def test_a_png_is_written_whole(tmp_path):
    figure, axis = pyplot.subplots()
    paper.draw_panel(axis, replace(Panel("", "", "", [Curve(X, X)]), whole=True))
    paper.save(figure, tmp_path / "a" / "figure.png")
    assert [path.name for path in (tmp_path / "a").iterdir()] == ["figure.png"]
    assert (tmp_path / "a" / "figure.png").read_bytes().startswith(b"\x89PNG")
