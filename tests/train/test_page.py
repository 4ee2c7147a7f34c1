"""What the page holds, and that it shows what was computed."""

import json
import platform
import re
from html import unescape
from html.parser import HTMLParser

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import lqg, no_control
from beamenv.scenarios.scenario import scenario
from train.page import Cell, Lead, LearningCurves, PageContent, Table, record_episode, write_page
from train.page.lead import blade_in_words, load_in_words
from train.page.page import plots, render
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
    monkeypatch.setattr("sys.argv", ["mine.py", "compare"])
    assert Lead("", "").command == ""


def test_loads_and_blades_are_told_in_words():
    assert load_in_words(scenario("quiet")) == "nothing"
    assert load_in_words(scenario("white")) == "white noise"
    assert load_in_words(scenario("step")) == "steps and white noise"
    assert "the rotor's own loads" in load_in_words(scenario("rotor"))
    blade = gym.make(beamenv.ENV_ID, speed=100.0).unwrapped.task.blade
    assert blade_in_words(blade) == "a blade of 2.023 m that turns at 100 rad/s, with 4 actuators and 4 sensors"


def test_cells_are_ranked_by_the_number_and_not_by_the_text(page, page_content):
    values = [attributes["data-value"] for tag, attributes in Elements(page).found if tag == "td" and "data-value" in attributes]
    assert [float(value) for value in values] == [cell.value for row in page_content.table.rows for cell in row[1:]]


def test_configuration_and_versions_are_told_without_the_name_of_the_host(page, page_content):
    found = versions()
    assert found["beamenv"] == beamenv.__version__
    assert found["numpy"] == np.__version__
    assert not platform.node() or platform.node() not in " ".join(found.values())
    (details,) = re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL)
    assert json.loads(details.replace("&#34;", '"')) == page_content.configuration
