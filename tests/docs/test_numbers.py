"""Numbers that the pages tell are those that the code gives, to the digits printed."""

import re
import sys
from functools import cache, reduce
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
from beamenv import UNSEEN_SCENARIOS
from beamenv.patches.material import PATCH_MATERIALS
from beamenv.plant.plant import sample
from beamenv.task import resolve_task

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

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


def number(path):
    """The value at a dotted path of ``numbers.toml``."""
    return reduce(lambda table, key: table[key], path.split("."), TOLD)


TOLD = tomllib.loads((ROOT / "docs" / "numbers.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", TOLD["told"], ids=lambda page: page["page"])
def test_numbers_that_several_pages_tell_are_those_of_one_file(page):
    text = " ".join((ROOT / page["page"]).read_text(encoding="utf-8").split())
    sentences = [re.sub(r"{([\w.-]+)}", lambda found: str(number(found[1])), each) for each in page["sentences"]]
    assert [sentence for sentence in sentences if sentence not in text] == []


def test_counts_of_verdicts_in_that_file_are_those_of_the_thesis_page():
    page = (ROOT / "docs" / "thesis.md").read_text(encoding="utf-8")
    cells = re.search(r"^\| their statements, in nature \|(.*)\|$", page, re.MULTILINE)[1].split("|")
    thesis = TOLD["thesis"]
    assert [thesis[name] for name in ("hold", "trend", "fail", "untested")] == [int(cell) for cell in cells]
    assert thesis["statements"] == sum(int(cell) for cell in cells)


def test_the_scenarios_in_which_an_agent_is_ahead_are_as_many_as_the_benchmark_has():
    page = (ROOT / "docs" / "benchmark.md").read_text(encoding="utf-8")
    verdicts = dict(re.findall(r"^\| `?([\w-]+)`? \|.*?\| (ahead|behind|not told apart) \|", page, re.MULTILINE))
    told = TOLD["benchmark"]
    kept = [verdict for scenario, verdict in verdicts.items() if scenario in UNSEEN_SCENARIOS]
    assert len(verdicts) == told["scenarios"]
    assert (len(kept), kept.count("ahead")) == (told["kept_for_judging"], told["ahead_in_kept"])
    assert list(verdicts.values()).count("ahead") == told["ahead_in_kept"]
    assert f"by Holm's method, the agent is ahead in {told['ahead_judged_together']} and" in page


def test_every_number_of_that_file_is_told_on_two_pages_or_compared_with_one():
    """What is told once need not stand in it."""
    told = [each[1] for page in TOLD["told"] for sentence in page["sentences"] for each in re.finditer(r"{([\w.-]+)}", sentence)]
    compared = ("thesis.", "benchmark.", "cluster.")
    assert [name for name in names(TOLD) if not name.startswith(compared) and told.count(name) < 2] == []


def names(table, path=""):
    """Dotted paths of the numbers in a table."""
    return [
        each
        for key, value in table.items()
        if key != "told"
        for each in (names(value, f"{path}{key}.") if isinstance(value, dict) else [f"{path}{key}"])
    ]


@pytest.mark.parametrize(("scenario", "key"), [("solid", "lqg"), ("solid-20", "lqg_of_20_modes")])
def test_lqg_on_the_solid_costs_what_the_benchmark_says(scenario, key):
    page = (ROOT / "docs" / "benchmark.md").read_text(encoding="utf-8")
    rows = page.partition(f"<summary>Every estimate: {scenario}</summary>")[2].partition("</details>")[0]
    assert re.search(r"\| lqg \|.*?(\d\.\d{3}) \[", rows)[1] == TOLD["solid"][key]


def test_strains_at_which_sheets_break_are_those_of_the_materials():
    assert TOLD["breaks"] == {name: f"{100 * PATCH_MATERIALS[name].failure_strain:.3f} %" for name in TOLD["breaks"]}


def test_speeds_of_a_cluster_are_calculated_from_what_was_measured():
    """Minutes on n workers: to begin, the work, blades of every scenario that a worker meets, and a last piece of 6 s."""
    page, told = (ROOT / "docs" / "cluster.md").read_text(encoding="utf-8"), TOLD["cluster"]
    (to_begin,) = re.findall(r"took 27.7 s, of which ([\d.]+) s were to begin", page)
    rows = re.findall(r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| (\d+) \|$", page, re.MULTILINE)
    assert [int(workers) for workers, *_ in rows] == [1, 2, 4, 16, 64]
    for workers, minutes, faster, busy in [[float(cell) for cell in row] for row in rows][1:]:
        blades = min(told["scenarios"], told["pieces"] / workers) * float(told["blades"]) / 60
        taken = told["begin"] / 60 + told["minutes"] / workers + blades + 6 / 60
        assert [minutes, faster] == pytest.approx([taken, told["minutes"] / taken], rel=0.04)
        assert busy == pytest.approx(told["minutes"] + workers * (blades + float(to_begin) / 60), abs=0.5)
