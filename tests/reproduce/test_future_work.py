"""Our own work in the page: shown and judged as the thesis' figures are, and counted apart."""

from dataclasses import replace

import numpy as np
import pytest

from train.figures.figure import Curve, Panel
from train.reproduce import catalogue
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Matches
from train.reproduce.report import html_page, markdown_page
from train.reproduce.runner import run
from train.reproduce.section import own_rule


def outcome(model):
    x = np.linspace(0.0, 1.0, 5)
    panels = [Panel("one", "x (m)", "y (m)", [Curve(x, x, "a")])]
    return Outcome({"limit": [2.0]}, panels, header=["x", "y"], rows=[[0.25, np.float64(1.0 / 3.0)]])


OWN = Study("graded-walls", "their stiffness", "a wall", (Statement("limit", "Of one metal", Matches((2.0,), 0.01, 0.1)),), outcome)
FIGURE = replace(OWN, name="figure-3.2")


@pytest.fixture
def records(tmp_path, monkeypatch):
    chapter = "Future work: done", (OWN, replace(OWN, name="heated-bar", rows_on_page=True))
    monkeypatch.setattr(catalogue, "FUTURE_WORK", chapter)
    monkeypatch.setattr(catalogue, "THESIS_STUDIES", (FIGURE,))
    monkeypatch.setattr(catalogue, "CHAPTERS", (("Chapter 3", (FIGURE,)), chapter))
    return run([FIGURE, *chapter[1]], tmp_path)


def test_own_work_is_counted_apart(records):
    page = markdown_page(records)
    assert "| tables and figures, in nature | 1 | 0 | 0 | 0 |" in page and "| their statements, in nature | 1 | 0 | 0 | 0 |" in page
    assert "of the 2 checks of what section 7.2 left to others, 2 hold." in page
    assert "checks of" not in markdown_page(records[:1])


def test_own_work_holds_or_does_not_and_reproduces_nothing(records):
    thesis, own = markdown_page(records).split("\n## Future work: done")
    assert "Check: ● holds (1 of 1 statements hold)." in own and "| Of one metal | holds within 1 % of every number, nearly" in own
    assert "reproduced" not in own.replace("Nothing of the thesis is reproduced", "") and "● reproduced" in thesis
    assert "regression check" in own


def test_rules_are_worded_for_own_work():
    assert own_rule("reproduced if above, trend if so, else not reproduced") == "holds if above, nearly if so, else does not hold"


def test_own_work_has_a_heading_of_its_name_and_expectations_where_the_thesis_has_statements(records):
    page = markdown_page(records)
    thesis, own = page.split("\n## Future work: done")
    assert "### Figure 3.2: their stiffness" in thesis and "### Graded walls: their stiffness" in own
    assert "| statement | thesis |" in thesis and "| statement | expected |" in own


def test_own_work_shows_its_rows_on_the_page_where_it_asks_for_it(records, tmp_path):
    shown = [record.rows for record in records]
    assert shown == [(), (), (("0.25", "0.3333333"),)]
    assert markdown_page(records).count("| 0.25 | 0.3333333 |") == 1 and "data:image/png" in html_page(records, tmp_path)
