"""Figures and tables of a page, by what they show."""

import re
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import plotly.graph_objects as go
import pytest

import beamenv
from baselines import evaluate, lqg, no_control
from train.comparison.page import page_table
from train.figures.palette import NEUTRAL, PALETTE, contrast
from train.figures.screen_heat_map import heat_map
from train.figures.themes import THEMES
from train.page import Cell, HeatMap, Table
from train.page.page import plots
from train.page.plots import amplitude_density


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


def test_natural_frequencies_are_marked_in_the_spectra(page_content):
    (figure,) = [plot.figure for plot in plots(page_content) if plot.name == "spectra"]
    modes = page_content.episode.blade.truth.natural_frequencies / (2.0 * np.pi)
    np.testing.assert_allclose([shape.x0 for shape in figure.layout.shapes], modes)
