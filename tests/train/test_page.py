"""What the page holds, and that it shows what was computed."""

import json
import platform
import re
from dataclasses import replace
from html.parser import HTMLParser
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import plotly.graph_objects as go
import pytest

import beamenv
from baselines import evaluate, lqg, no_control
from beamenv.blade.shape import magnification
from train.comparison.page import page_table
from train.figures.palette import NEUTRAL, PALETTE, contrast
from train.figures.screen_heat_map import heat_map
from train.figures.themes import THEMES
from train.page import Cell, HeatMap, LearningCurves, PageContent, Recording, Table, record_episode, write_page
from train.page.blade import ROUND, SHOWN_DEFLECTION, blade_figures, frame_times, motions
from train.page.page import plots, render
from train.page.plots import amplitude_density
from train.shared.versions import versions

SECTIONS = ("table", "blade", "heat-map", "time-series", "spectra", "poles", "learning", "provenance")


class Elements(HTMLParser):
    """Every element's tag and attributes."""

    def __init__(self, page):
        super().__init__()
        self.found = []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))


@pytest.fixture(scope="module")
def page(page_content):
    return render(page_content)


def test_every_part_is_on_the_page(page):
    identities = {attributes.get("id") for _, attributes in Elements(page).found}
    assert set(SECTIONS) <= identities


def test_parts_that_are_none_are_left_out():
    identities = {attributes.get("id") for _, attributes in Elements(render(PageContent("Nothing yet"))).found}
    assert identities.intersection(SECTIONS) == {"provenance"}


def test_nothing_is_loaded_from_the_network(page):
    elements = Elements(page).found
    assert [attributes for _, attributes in elements if "src" in attributes or "srcset" in attributes] == []
    assert [attributes["href"] for _, attributes in elements if not attributes.get("href", "data:,").startswith("data:")] == []
    (policy,) = [attributes["content"] for tag, attributes in elements if attributes.get("http-equiv") == "Content-Security-Policy"]
    assert policy.startswith("default-src 'none';")
    assert not re.search(r"\bhttps?:", policy)
    (style,) = re.findall(r"<style>(.*?)</style>", page, re.DOTALL)
    assert "@import" not in style and "url(" not in style


def test_plotly_is_inlined_once(page):
    assert page.count("plotly.js v") == 1
    assert len(page) < 6.5e6


def test_text_cannot_end_a_script_or_become_one():
    evil = "</script><script>alert(1)</script>"
    learned = LearningCurves({evil: np.array([[1.0, 10.0, 0.9], [2.0, 20.0, 0.8]])})
    table = Table(("controller",), ((Cell(evil),),), evil)
    page = render(PageContent(evil, evil, table, learning=learned, configuration={evil: evil}))
    assert "<script>alert" not in page


def test_the_page_is_written_whole(tmp_path):
    write_page(tmp_path / "a" / "report.html", PageContent("A page"))
    assert [path.name for path in (tmp_path / "a").iterdir()] == ["report.html"]
    assert (tmp_path / "a" / "report.html").read_text(encoding="utf-8").rstrip().endswith("</html>")


def test_axes_have_units_and_plots_have_headings(page_content):
    units = {
        "heat-map": {"controller", "scenario"},
        "time-series": {"time, ms", "µm", "V"},
        "spectra": {"frequency, Hz", "µm/√Hz"},
        "poles": {"real part, rad/s", "imaginary part, rad/s"},
        "learning": {"training time, s", "J / J without control"},
    }
    shown = {plot.name: plot for plot in plots(page_content)}
    assert set(shown) == set(units)
    for name, plot in shown.items():
        layout = plot.figure.to_plotly_json()["layout"]
        axes = {value["title"]["text"] for key, value in layout.items() if re.match(r"[xy]axis", key)}
        assert axes == units[name]
        assert plot.heading and plot.note


# The blade.


def test_the_drawn_tip_moves_by_the_magnified_tip_displacement_and_the_root_stays(page_content):
    episode = page_content.episode
    moved, factor = motions(episode)
    times = frame_times(episode)
    for motion, figure in zip(moved, blade_figures(episode), strict=True):
        recording = motion.recording
        at = np.rint(times / episode.blade.config.control_interval).astype(int)
        np.testing.assert_allclose(motion.displacement[:, :2, -1], factor * recording.tip[at], atol=1e-9)
        assert len(figure.frames) == len(times)
        lag = np.stack([frame.data[0].x for frame in figure.frames])
        np.testing.assert_allclose(lag[:, :4], np.broadcast_to(lag[0, :4], (len(times), 4)), atol=1e-6)
        middle = lag[:, -4:].mean(axis=1)  # of the tip's corners, about which it twists
        np.testing.assert_allclose(middle - middle[0], factor * (recording.tip[at, 0] - recording.tip[0, 0]), atol=1e-6)


def test_a_blade_that_failed_stays_as_it_was_last(page_content):
    whole, short = page_content.episode.pair
    short = Recording(short.name, *(series[:60] for series in (short.time, short.states, short.tip, short.volts)))
    episode = replace(page_content.episode, pair=(whole, short))
    (_, lost), _ = motions(episode)
    assert len(lost.displacement) == len(frame_times(episode)) == 26
    np.testing.assert_array_equal(lost.rows[-10:], 59)


def test_both_blades_are_drawn_to_one_scale_and_coloured_on_one(page_content):
    left, right = (figure.to_plotly_json()["layout"] for figure in blade_figures(page_content.episode))
    assert left["scene"] == right["scene"]
    assert left["coloraxis"] == right["coloraxis"]
    assert (left["coloraxis"]["cmin"], left["coloraxis"]["cmax"]) == (-1500.0, 1500.0)


def test_actuators_are_coloured_by_the_voltage_of_the_frame(page_content):
    episode = page_content.episode
    _, figure = blade_figures(episode)
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    shades = np.stack([frame.data[1].intensity for frame in figure.frames]).reshape(len(at), 4, -1)
    np.testing.assert_allclose(shades[:, :, 0], episode.pair[1].volts[at], rtol=1e-6)
    assert np.all(shades == shades[:, :, :1])


@pytest.mark.parametrize(("largest", "factor"), [(4e-4, 1000.0), (3e-4, 1000.0), (1.9e-4, 2000.0), (4e-1, 1.0), (0.0, 1.0)])
def test_deflections_are_magnified_to_at_most_a_fifth_of_the_span(largest, factor):
    assert magnification(largest, SHOWN_DEFLECTION * 2.023, ROUND) == factor


# Plots.


def test_power_of_a_sine_is_half_its_amplitude_squared():
    # Parseval: the spectral density of a sin(2 pi f t), integrated over frequency, is a^2/2.
    interval, amplitude, frequency = 5e-4, 3e-4, 40.0
    signal = 0.1 + amplitude * np.sin(2.0 * np.pi * frequency * interval * np.arange(1000))
    frequencies, density = amplitude_density(signal, interval)
    assert np.sum(density**2) * (frequencies[1] - frequencies[0]) == pytest.approx(0.5 * amplitude**2, rel=1e-6)
    assert frequencies[np.argmax(density)] == pytest.approx(frequency)


def test_grey_is_without_control(page_content):
    shown = {plot.name: plot.figure for plot in plots(page_content)}
    for name in ("time-series", "spectra"):
        assert [trace.name.startswith("no control") for trace in shown[name].data if trace.line.color == NEUTRAL] == [True, True]


@pytest.mark.parametrize("theme", THEMES)
def test_colours_have_the_contrast_that_wcag_asks_of_lines_and_of_text(theme):
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    colours = THEMES[theme]
    assert min(contrast(colour, colours.panel) for colour in (*PALETTE, NEUTRAL)) >= 3.0
    for background in (colours.panel, colours.paper):
        assert contrast(colours.ink, background) >= 7.0
        assert contrast(colours.faint, background) >= 4.5


# Tables.


def test_cells_are_ranked_by_the_number_and_not_by_the_text(page, page_content):
    values = [attributes["data-value"] for tag, attributes in Elements(page).found if tag == "td" and "data-value" in attributes]
    assert [float(value) for value in values] == [cell.value for row in page_content.table.rows for cell in row[1:]]


def test_the_comparison_is_a_table_with_the_best_first():
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=3, duration=0.2)
    plant = envs.unwrapped.plant
    evaluations = [evaluate(law, envs, range(3)) for law in (no_control(plant), lqg(plant))]
    envs.close()
    table = page_table(evaluations)
    assert [row[0].text for row in table.rows] == ["LQG", "no control"]
    assert table.rows[1][1].value == 1.0
    assert table.rows[0][1].value == evaluations[1].relative_cost.value


def test_a_row_of_another_length_is_refused():
    with pytest.raises(ValueError, match="rows has one of 1 cells, but each must have 2"):
        Table(("controller", "J"), ((Cell("LQG"),),))


def test_a_failed_blade_is_marked_with_the_share_of_failures():
    content = HeatMap(("step", "pulse"), ("LQG", "PPO"), np.array([[0.4, 0.5], [np.inf, 0.8]]), np.array([[0.0, 0.0], [0.25, 0.5]]))
    cells, missing = go.Figure(heat_map(content)).data
    written = [[re.sub("</?span[^>]*>", "", text) for text in row] for row in cells.text]
    assert written == [["0.40", "0.50"], ["∞<br>▲ 25 %", "0.80<br>▲ 50 %"]]
    assert cells.z[1][0] == np.max(cells.z)
    assert list(missing.text) == []


def test_a_heat_map_of_evaluations_leaves_what_was_not_run_empty():
    def evaluation(name, cost, failed):
        episodes = SimpleNamespace(failed=np.array(failed))
        return SimpleNamespace(name=name, relative_cost=SimpleNamespace(value=cost), episodes=episodes)

    content = HeatMap.of(
        {
            "step": [evaluation("LQG", 0.4, [False, False])],
            "gust": [evaluation("PPO", np.inf, [True, False]), evaluation("LQG", 0.5, [False, False])],
        }
    )
    assert content.controllers == ("LQG", "PPO")
    np.testing.assert_array_equal(content.relative_cost, [[0.4, np.nan], [0.5, np.inf]])
    np.testing.assert_array_equal(content.failed, [[0.0, 0.0], [0.0, 0.5]])


def test_a_heat_map_of_another_shape_is_refused():
    with pytest.raises(ValueError, match=r"failed has shape \(1,\), but must have \(1, 2\)"):
        HeatMap(("step",), ("LQG", "PPO"), np.ones((1, 2)), np.zeros(1))


# Provenance.


def test_configuration_and_versions_are_told_without_the_name_of_the_host(page, page_content):
    found = versions()
    assert found["beamenv"] == beamenv.__version__
    assert found["numpy"] == np.__version__
    assert not platform.node() or platform.node() not in " ".join(found.values())
    (details,) = re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL)
    assert json.loads(details.replace("&#34;", '"')) == page_content.configuration


def test_natural_frequencies_are_marked_in_the_spectra(page_content):
    (figure,) = [plot.figure for plot in plots(page_content) if plot.name == "spectra"]
    modes = page_content.episode.blade.truth.natural_frequencies / (2.0 * np.pi)
    np.testing.assert_allclose([shape.x0 for shape in figure.layout.shapes], modes)


def test_the_solid_is_shown_as_far_as_the_beam_has_its_modes():
    idle = no_control(gym.make(beamenv.ENV_ID).unwrapped.plant)
    episode = record_episode({"duration": 0.05, "scenario": "solid-20"}, 3, (idle, idle))
    assert episode.without_control.states.shape[1] == len(episode.blade.truth.A)
    pair, factor = motions(episode)
    shown = pair[0].displacement[:, :2, -1] / factor
    true = episode.without_control.tip[pair[0].rows]
    assert np.abs(shown - true).max() < 0.05 * np.abs(true).max()
