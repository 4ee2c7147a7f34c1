"""Numbers that the pages tell are those that the code gives, to the digits printed."""

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from baselines import (
    PersistentLoad,
    lqg,
    lqr,
    positive_position_feedback,
    reference_lqg,
    stability_margins,
    stationary_cost,
    velocity_feedback,
)
from baselines.design.loop import closed_loop
from beamenv.plant.plant import sample
from beamenv.task import resolve_task

ROOT = Path(__file__).parents[2]
LQG = (ROOT / "docs" / "lqg.md").read_text(encoding="utf-8")


@cache
def plants():
    """(the eleven modes of the design, all modes of the design, the default blade)."""
    task = resolve_task()
    return task.design_plant, task.design.full_plant, task.plant


ELEVEN = {
    "LQR (full state)": lambda design, full: lqr(design),
    "LQG": lambda design, full: lqg(design),
    "LQG (thesis)": lambda design, full: lqg(design, "continuous"),
    "LQG with load estimate": lambda design, full: lqg(design, persistent_load=PersistentLoad()),
}
ALL = {
    "LQG told the truth": lambda design, full: lqg(full),
    "LQG, the reference": lambda design, full: reference_lqg(full),
    "LQG with load estimate": lambda design, full: reference_lqg(full, load=PersistentLoad()),
    "positive position feedback": lambda design, full: positive_position_feedback(full),
    "velocity feedback": lambda design, full: velocity_feedback(design, tuned_on=full),
}


def margin_rows(table):
    """Cells of the page's first table of margins, of the eleven modes, or its second, by the controller's name."""
    text = LQG.split("| controller | gain margin, dB |")[1 + table].split("\n\n")[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()[2:]]
    return {name: gain.split(" … ") + cells for name, gain, *cells in rows}


@pytest.mark.parametrize(
    ("table", "name"), [(table, name) for table, laws in enumerate((ELEVEN, ALL)) for name in laws], ids=lambda each: str(each)
)
def test_margins_of_the_lqg_page_are_those_of_the_loop(table, name):
    design, full, truth = plants()
    plant, laws = (design, ELEVEN) if table == 0 else (truth, ALL)
    assert set(margin_rows(table)) == set(laws)
    law = laws[name](design, full)
    margins = stability_margins(plant, law)
    cost = stationary_cost(plant, law) / stationary_cost(plant, lqg(plant))
    values = (*margins.gain_margin_db, margins.phase_margin_deg, 1e3 * margins.delay_margin, margins.disk_margin, cost)
    printed = margin_rows(table)[name]
    assert len(printed) == len(values)
    for text, value in zip(printed, values, strict=True):
        number = float(text.replace("−", "-").replace("∞", "inf"))
        digit = 10.0 ** -len(text.partition(".")[2])
        assert value == pytest.approx(number, abs=0.6 * digit), (text, value)  # rounded, and a tenth of a digit for other machines


def test_spectral_radii_of_the_lqg_page_are_those_of_the_loop():
    design, _, truth = plants()
    told = re.search(r"spectral radii of ([\d.]+) and ([\d.]+),", LQG)
    radii = [np.abs(np.linalg.eigvals(closed_loop(sample(truth), lqg(design, way))[0])).max() for way in ("sampled", "continuous")]
    assert [float(number) for number in told.groups()] == pytest.approx(radii, abs=0.0006)


def test_the_blade_has_as_many_modes_as_the_pages_say():
    errata = (ROOT / "docs" / "thesis-errata.md").read_text(encoding="utf-8")
    assert len(plants()[2].natural_frequencies) == 21
    assert "has twenty-one modes below the Nyquist frequency" in LQG
    assert "the blade that has twenty-one |" in errata


def test_the_badge_of_gymnasium_is_what_the_package_asks_for():
    lowest = re.search(r'"gymnasium>=([\d.]+)', (ROOT / "pyproject.toml").read_text(encoding="utf-8"))[1]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"[Gymnasium {lowest} and newer]" in readme
    assert f"Gymnasium-{lowest}_and_newer-" in readme


def test_patches_at_the_clamp_have_one_figure_on_all_pages():
    """That of `tests/plant/test_clamp.py`."""
    for page, words in {
        "docs/placement.md": "from solid elements by up to 7 %",
        "docs/physics.md": "| up to 110 % | up to 7 % | 3-D solid elements |",
        "beamenv/envs/single.py": "of a solid of finite elements by up to 7 %",
        "beamenv/blade/clamp.py": "by up to 7 %",
    }.items():
        assert words in (ROOT / page).read_text(encoding="utf-8"), page


def test_counts_of_verdicts_told_of_the_thesis_are_those_of_its_page():
    page, told = ((ROOT / "docs" / name).read_text(encoding="utf-8") for name in ("thesis.md", "beyond-the-thesis.md"))
    nature, equations = (
        [int(cell) for cell in re.search(rf"^\| their statements, {by} \|(.*)\|$", page, re.MULTILINE)[1].split("|")]
        for by in ("in nature", "by the thesis' equations")
    )
    told = " ".join(told.split())
    assert f"Of {sum(nature)} statements {nature[0]} hold in nature and {equations[0]} by the thesis' equations" in told
    assert f"{equations[3]} cannot be evaluated by these" in told
    missed, rest = re.search(r"Of the (\d+) statements that do not fully hold in nature, (its equations .*?):", page).groups()
    assert f"Of the {missed} that do not fully hold in nature, {rest}" in told
