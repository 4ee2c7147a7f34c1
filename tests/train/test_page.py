"""What the page holds, and that it shows what was computed."""

import base64
import json
import platform
import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import plotly.graph_objects as go
import pytest

import beamenv
from baselines import evaluate, lqg, no_control
from beamenv.blade.shape import bodies
from beamenv.scenarios.scenario import scenario
from train.comparison.page import page_table
from train.figures.palette import NEUTRAL, PALETTE, contrast
from train.figures.screen_heat_map import heat_map
from train.figures.themes import THEMES
from train.page import Cell, HeatMap, Lead, LearningCurves, PageContent, Table, record_episode, write_page
from train.page.blade import drawn_blade, frame_times, shapes_and_amplitudes
from train.page.lead import blade_in_words, load_in_words
from train.page.page import plots, render
from train.page.plots import amplitude_density
from train.shared.versions import versions

SECTIONS = ("table", "blade", "episode", "heat-map", "time-series", "spectra", "poles", "learning", "provenance")


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


def test_who_cannot_see_the_page_is_told_what_it_shows(page):
    found = Elements(page).found
    identities = [attributes["id"] for _, attributes in found if "id" in attributes]
    assert len(identities) == len(set(identities))
    referred = " ".join(attributes.get("aria-describedby", "") for _, attributes in found).split()
    assert len(referred) == 9 and set(referred) <= set(identities)
    pictures = [attributes for tag, attributes in found if attributes.get("class") == "figure" or tag == "canvas"]
    assert len(pictures) == 7
    assert all(
        attributes["role"] == "img" and attributes["aria-label"] and attributes["aria-describedby"] for attributes in pictures
    )
    assert {attributes["aria-sort"] for tag, attributes in found if tag == "th" and attributes.get("scope") == "col"} == {"none"}
    assert sum(tag == "th" and attributes.get("scope") == "row" for tag, attributes in found) == 4 + len(versions()) + 1


def test_figures_are_told_in_numbers(page_content):
    episode = page_content.episode
    told = {plot.name: plot.instead for plot in plots(page_content)}
    lag, flap = 1e6 * np.abs(episode.without_control.tip).max(axis=0)
    assert (
        f"no control: tip displacement, lag {lag:.3g} µm, tip displacement, flap {flap:.3g} µm, voltage 0 V; LQG: "
        in told["time-series"]
    )
    largest = {name: values.real.max() for name, values in page_content.poles.items()}
    assert told["poles"].count("rad/s") == 2 and max(largest.values()) < 0.0 and "no control −" in told["poles"]
    assert told["learning"] == "J over J without control in the end: PPO 0.600 after 3 s; LQG 0.400."


def test_every_section_is_linked_to_in_its_order(page):
    found = Elements(page).found
    links = [attributes["href"] for tag, attributes in found if tag == "a"]
    assert links == [f"#{attributes['id']}" for tag, attributes in found if tag == "section"] and len(links) == 8


def test_parts_that_are_none_are_left_out():
    identities = {attributes.get("id") for _, attributes in Elements(render(PageContent("Nothing yet"))).found}
    assert identities.intersection(SECTIONS) == {"provenance"}


def test_nothing_is_loaded_from_the_network(page):
    elements = Elements(page).found
    assert [attributes for _, attributes in elements if "src" in attributes or "srcset" in attributes] == []
    assert [attributes["href"] for _, attributes in elements if not attributes.get("href", "#").startswith(("data:", "#"))] == []
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


def unpacked(text, *shape):
    return np.frombuffer(base64.b64decode(text), dtype="<f4").reshape(*shape)


def moved(blade):
    """(F, 3, S) of each recording: shapes times amplitudes."""
    stations = len(unpacked(blade["stations"], -1))
    shapes = unpacked(blade["shapes"], -1, 3, stations).astype(float)
    return [np.einsum("fr,rds->fds", unpacked(each["amplitudes"], -1, len(shapes)), shapes) for each in blade["recordings"]]


@pytest.fixture(scope="module")
def drawn(page_content):
    return drawn_blade(page_content.episode)


def test_the_drawn_tip_moves_by_the_tip_displacement_and_the_root_stays(page_content, drawn):
    episode = page_content.episode
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    for recording, displacement in zip(episode.recordings, moved(drawn), strict=True):
        largest = np.abs(recording.tip).max()
        np.testing.assert_allclose(displacement[:, :2, -1], recording.tip[at], atol=1e-5 * largest)
        assert np.abs(displacement[:, :, 0]).max() < 1e-5 * largest


def test_the_plant_of_the_episode_is_drawn_and_not_the_design():
    """In "off-speed" each episode has another plant, whose states mean something else."""
    idle = no_control(gym.make(beamenv.ENV_ID).unwrapped.plant)
    episode = record_episode({"duration": 0.02, "scenario": {"preset": "off-speed", "plants": {"bank": 4}}}, 3, {"idle": idle})
    (displacement,) = moved(drawn_blade(episode))
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    tip = episode.without_control.tip[at]
    np.testing.assert_allclose(displacement[:, :2, -1], tip, atol=1e-4 * np.abs(tip).max())


def test_a_blade_that_failed_stays_as_it_was_last(page_content):
    short = page_content.episode.recordings[1]
    short = replace(short, **{name: getattr(short, name)[:60] for name in ("time", "states", "tip", "volts", "readings", "truth")})
    episode = replace(page_content.episode, recordings=(page_content.episode.without_control, short))
    whole, lost = drawn_blade(episode)["recordings"]
    assert whole["failed"] is None and lost["failed"] == pytest.approx(29.5)
    volts = unpacked(lost["volts"], -1, 4)
    assert len(volts) == len(frame_times(episode)) == 26
    np.testing.assert_allclose(volts[-10:], np.broadcast_to(short.volts[-1], (10, 4)), rtol=1e-6)


def test_a_blade_that_moves_out_of_all_bounds_takes_no_shape_from_the_others():
    small, shapes = np.random.default_rng(0).normal(size=(40, 3)), np.random.default_rng(1).normal(size=(3, 3, 9))
    displacements = [np.einsum("fr,rds->fds", 10.0**power * small, shapes) for power in (-4, 6)]
    found, amplitudes = shapes_and_amplitudes(displacements)
    assert len(found) == 3
    for expected, amplitude in zip(displacements, amplitudes, strict=True):
        np.testing.assert_allclose(np.einsum("fr,rds->fds", amplitude, found), expected, atol=1e-12 * np.abs(expected).max())


def test_the_blade_at_rest_is_the_beams_contour_and_has_its_patches_and_its_hub(page_content, drawn):
    blade = page_content.episode.blade
    at = {name: unpacked(values, -1) for name, values in drawn["vertices"].items()}
    turned = np.exp(1j * at["angle"]) * (at["along"] + 1j * at["across"])
    stations = unpacked(drawn["stations"], -1)
    (body,) = drawn["bodies"]
    here = slice(body["first"], body["first"] + body["stations"] * body["corners"])
    skin = bodies(blade.beam, stations.astype(float))[0].at_rest().reshape(-1, 3)
    np.testing.assert_allclose(np.stack([turned.real[here], turned.imag[here]], axis=-1), skin[:, :2], atol=1e-7)
    patches = blade.config.patches
    assert (len(drawn["actuators"]), len(drawn["sensors"]), drawn["points"]) == (4, 4, [])
    starts = [inlay.start for group in patches.groups("actuators") for inlay in group.inlays("actuators", blade.config.beam.length)]
    np.testing.assert_allclose(stations[at["station"][drawn["actuators"]].astype(int)], starts, atol=1e-6)
    assert max(corner[2] for face in drawn["hub"] for corner in face) == 0.0
    assert drawn["readBy"]["sensors"] == [0, 1, 2, 3]


def test_actuators_have_the_voltage_and_sensors_the_output_of_the_frame(page_content, drawn):
    episode = page_content.episode
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    for recording, told in zip(episode.recordings, drawn["recordings"], strict=True):
        np.testing.assert_allclose(unpacked(told["volts"], -1, 4), recording.volts[at], rtol=1e-6)
        outputs = unpacked(told["outputs"], -1, 4)
        np.testing.assert_allclose(outputs, (recording.readings / episode.blade.truth.sensor_full_scale)[at], rtol=1e-6)
        assert 0.0 < np.abs(outputs).max() <= 1.0


def test_what_is_dead_is_told_frame_by_frame():
    idle = no_control(gym.make(beamenv.ENV_ID).unwrapped.plant)
    dead = drawn_blade(record_episode({"duration": 0.02, "scenario": "two-dead-actuators"}, 3, {"idle": idle}))["recordings"][0][
        "dead"
    ]
    assert len(dead) == 6 and all(each == dead[0] for each in dead)
    assert len(dead[0]) == 2 and max(dead[0]) < 4
    later = record_episode({"duration": 0.4, "scenario": "mid-failure"}, 3, {"idle": idle})
    first, *_, last = drawn_blade(later)["recordings"][0]["dead"]
    assert first == [] and len(last) == 1


def test_each_controller_is_recorded_once_and_no_control_first(page_content):
    episode = page_content.episode
    assert [each.name for each in episode.recordings] == ["no control", "LQG", "LQR"]
    assert episode.opens == 1 and episode.without_control.volts.any() == np.False_
    assert max(each.cost for each in episode.recordings[1:]) < episode.without_control.cost
    idle = no_control(episode.task.plant)
    alone = record_episode({"duration": 0.01}, 3, {"none": idle})
    assert [each.name for each in alone.recordings] == ["no control"] and alone.opens == 0
    with pytest.raises(ValueError, match="opens is 'PPO', but must be one of LQG"):
        record_episode({"duration": 0.01}, 3, {"LQG": lqg(episode.task.plant)}, "PPO")


def test_readers_choose_among_all_recordings(page):
    found = Elements(page).found
    assert [attributes["value"] for tag, attributes in found if tag == "option"] == ["0", "1", "2"] * 2
    assert [attributes["value"] for tag, attributes in found if tag == "option" and "selected" in attributes] == ["0", "1"]


def test_the_lead_tells_result_subject_date_and_command(page):
    (lead,) = re.findall(r'<p class="lead">(.*?)</p>', page)
    version = beamenv.__version__
    assert unescape(lead) == (
        f"J falls. A blade moves. Made on 1 May 2026 with beamenv {version} by <code>beamenv compare 'a b'</code>."
    )


def test_the_command_is_the_one_that_was_typed(monkeypatch):
    monkeypatch.setattr("sys.argv", ["/usr/bin/beamenv", "compare", "--folder", "a folder", "--episodes", "4"])
    assert Lead("", "").command == "beamenv compare --folder 'a folder' --episodes 4"
    monkeypatch.setattr("sys.argv", ["/tmp/mine.py", "compare"])
    assert Lead("", "").command == ""


def test_loads_and_blades_are_told_in_words():
    assert load_in_words(scenario("quiet")) == "nothing"
    assert load_in_words(scenario("white")) == "white noise"
    assert load_in_words(scenario("step")) == "steps and white noise"
    assert "the rotor's own loads" in load_in_words(scenario("rotor"))
    blade = gym.make(beamenv.ENV_ID, speed=100.0).unwrapped.task.blade
    assert blade_in_words(blade) == "a blade of 2.023 m that turns at 100 rad/s, with 4 actuators and 4 sensors"


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


def test_columns_without_numbers_are_text():
    rows = ((Cell("LQG"), Cell("0.4", 0.4), Cell("fixed")), (Cell("none"), Cell("–"), Cell("fixed")))
    assert Table(("controller", "J", "kind"), rows).text_columns == (0, 2)


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
    episode = record_episode({"duration": 0.05, "scenario": "solid-20"}, 3, {"idle": idle})
    assert episode.without_control.states.shape[1] == len(episode.blade.truth.A)
    (displacement,) = moved(drawn_blade(episode))
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    true = episode.without_control.tip[at]
    assert np.abs(displacement[:, :2, -1] - true).max() < 0.05 * np.abs(true).max()
