"""Names of controllers, agents, folders and scenarios come from other people: pages and pictures show them as they stand."""

import json
import re
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import plotly.graph_objects as go
import pytest

from train.figures import paper, screen
from train.figures.figure import Curve, Panel
from train.figures.heat_map import HeatMap
from train.figures.panels import LearningCurves, learning_panel, pole_panel
from train.figures.paper_heat_map import heat_map as paper_heat_map
from train.figures.screen_heat_map import heat_map
from train.page import Cell, PageContent, Table
from train.page.page import render

EVIL = [
    "<script>alert(1)</script>",
    "</script><script>alert(2)</script>",
    '"><img src=x onerror=alert(3)>',
    "'><svg onload=alert(4)>",
    '<a href="https://evil.example">LQG</a>',
    "<b>best</b><br>",
    "{{ 7 * 7 }}{% raw %}",
    "a\u2028b\u2029c\x00d\ne\u202ef",
    r"$\frac{$",
    "_hidden",
    "%{x} %{y:.2f}",
    "&lt;script&gt;",
    "<!--",
]
NUMBERS = re.compile(r'^<span style="color:#[0-9a-f]{6}">0\.50<br>▲ 10 %</span>$')
"""What a cell of a heat map says, in which no name stands."""
MARKED = re.compile(r"<(?!\s|$)")


@pytest.fixture
def small(monkeypatch):
    """Pages without plotly's own 5 MB."""
    monkeypatch.setattr("train.page.page.get_plotlyjs", lambda: "")


def heat_of(names):
    return HeatMap(tuple(names), tuple(names), np.full((len(names),) * 2, 0.5), np.full((len(names),) * 2, 0.1), tuple(names))


def everywhere(name):
    """A page that shows a name wherever one can stand."""
    learned = LearningCurves({name: np.array([[1.0, 10.0, 0.9], [2.0, 20.0, 0.8]])}, {name: 0.5})
    table = Table((name, "J"), ((Cell(name), Cell(name, 0.5)),), name)
    poles = {name: np.array([-1.0 + 5.0j])}
    configuration = {name: [name]}
    return PageContent(name, "", table, heat_of([name]), poles=poles, learning=learned, configuration=configuration)


def elements(page):
    return sorted(re.findall(r"<[/!]?[A-Za-z-]+", re.sub(r"(?s)(<script[^>]*>).*?(?=</script>)", r"\1", page)))


@pytest.mark.parametrize("name", EVIL, ids=ascii)
def test_a_name_becomes_no_element_of_the_page(name, small):
    page = render(everywhere(name))
    assert elements(page) == elements(render(everywhere("harmless")))
    for content in re.findall(r'(?s)<script type="application/json"[^>]*>(.*?)</script>', page):
        assert "<" not in content
        json.loads(content)


def texts(figure):
    """Every text of a figure, its templates left out."""
    for key, value in figure.items() if isinstance(figure, dict) else enumerate(figure):
        if isinstance(value, str):
            if key not in ("texttemplate", "hovertemplate"):
                yield value
        elif isinstance(value, (dict, list, tuple)):
            yield from texts(value)


@pytest.mark.parametrize("name", EVIL, ids=ascii)
def test_plotly_takes_no_name_for_markup(name):
    panels = [pole_panel({name: np.array([-1.0 + 5.0j])}), learning_panel(everywhere(name).learning)]
    panels.append(Panel(name, name, name, [Curve(np.arange(2.0), np.arange(2.0), name)]))
    for figure in [*(screen.figure([panel]) for panel in panels), heat_map(heat_of([name]))]:
        go.Figure(figure)
        assert [text for text in texts(figure) if MARKED.search(NUMBERS.sub("", text))] == []


@pytest.mark.filterwarnings("ignore:Glyph", "ignore:constrained_layout")
def test_matplotlib_takes_no_name_for_a_formula_and_lists_each(tmp_path):
    figure, axis = plt.subplots()
    curves = [Curve(np.arange(2.0), np.arange(2.0), name) for name in EVIL]
    paper.draw_panel(axis, Panel(EVIL[8], EVIL[8], EVIL[8], curves))
    axis.legend(handles=paper.handles([Panel("", "", "", curves)]))
    figure.draw_without_rendering()
    listed = [text.get_text().replace(r"\$", "$").strip() for text in axis.get_legend().get_texts()]
    assert listed == [screen.on_one_line(name).strip() for name in EVIL]
    plt.close(figure)
    paper.save(paper_heat_map(heat_of(EVIL[7:10])), tmp_path / "map.png")


def test_controllers_of_an_episode_are_shown_by_their_names_whatever_these_are(page_content, small):
    idle, law, *_ = page_content.episode.recordings
    odd, plain = ([replace(law, name=name) for name in names] for names in (EVIL, [f"law {k}" for k in range(len(EVIL))]))
    pages = [
        render(PageContent("", episode=replace(page_content.episode, recordings=(idle, *recordings))))
        for recordings in (odd, plain)
    ]
    assert elements(pages[0]) == elements(pages[1])
    assert [page.count("</script>") for page in pages] == [pages[1].count("</script>")] * 2
