"""The benchmark's page of the documentation: definitions, findings in one table, and all numbers folded."""

import re

import numpy as np
import pytest

from beamenv.scenarios.named import UNSEEN
from train.benchmark.cells import SERIES, Cell
from train.benchmark.contests import contests
from train.benchmark.listed import ListedController
from train.benchmark.showing.docs import page
from train.benchmark.showing.findings import findings_table
from train.benchmark.showing.legend import details, terms
from train.benchmark.table import tabulate
from train.benchmark.targets import leaders_of, reaches

UNCONTROLLED = np.random.default_rng(0).gamma(4.0, size=24)
COSTS = {"none": 1.0, "lqg": 0.6, "mine-generalist": 0.5, "clairvoyant": 0.4}
KINDS = {"mine-generalist": ("learned", 1), "clairvoyant": ("scheduled", 3)}
SCENARIOS = ("nominal", "delay", "drift", *UNSEEN[:2], "gusty")


def table_of(costs=COSTS, scenarios=SCENARIOS, broken=()):
    """J / J₀ by controller, of every scenario alike; some pairs of scenario and controller could not be measured."""
    listed = [ListedController(name, *KINDS.get(name, ("fixed", 0)), {"": None}) for name in costs]
    cells = []
    for scenario in scenarios:
        for name, cost in costs.items():
            metrics = {each: np.zeros(24) for each in SERIES} | {"cost": cost * UNCONTROLLED}
            measured = {"uncontrolled": UNCONTROLLED, "fails": np.zeros(24), "metrics": metrics}
            cells.append(Cell(scenario, name, "", **({"sentence": "It <fails>."} if (scenario, name) in broken else measured)))
    return tabulate(cells, listed, {}, {"seeds": [0, 23], "versions": {"numpy": "2"}})


@pytest.fixture(scope="module")
def table():
    return table_of(broken=[("gusty", "lqg")])


@pytest.fixture(scope="module")
def text(table):
    return page(table, "beamenv benchmark")


def visible(text):
    """What is not folded."""
    return re.sub(r"<details markdown>.*?</details>", "", text, flags=re.DOTALL)


def rows_of(section):
    return {row[0].text: dict(zip(section.headings[1:], (each.text for each in row[1:]), strict=True)) for row in section.rows}


def test_words_are_explained_before_they_are_used(table, text):
    headings = re.findall(r"^## (.*)$", text, flags=re.MULTILINE)
    assert headings[:2] == ["What the words mean", "Findings"] and headings[-1] == "How it was made"
    before = text.partition("## Findings")[0]
    assert all(f"\n| {word.split(' /')[0]}" in before for word in terms(table))
    assert all(meaning.split(".")[0][:40] in before for meaning in details().values())


def test_every_scenario_has_a_folded_table_and_nothing_else_is_that_long(table, text):
    folded = re.findall(r"<summary>(.*?)</summary>\n\n(.*?)\n\n</details>", text, flags=re.DOTALL)
    inside = dict(folded)
    for name in table.scenarios:
        body = inside[f"Every estimate: {name}"]
        assert body.count("\n| ") >= len(COSTS) and "Without control the blade fails in" in body
    assert {summary for summary in inside if summary.startswith("J / J₀: ")} == {
        *("J / J₀: single fault, 2 scenarios", "J / J₀: open, 1 scenarios", "J / J₀: unseen, 2 scenarios"),
        "J / J₀: other, 1 scenarios",
    }
    assert "settled, %" not in visible(text) and "settled, %" in text


def test_what_went_wrong_is_told_and_becomes_no_markup(text):
    assert "- lqg in gusty: It &lt;fails>." in text.partition("<summary>What went wrong</summary>")[2]


def test_what_is_folded_is_closed_again(text):
    assert text.count("<details markdown>") == text.count("</details>") > 5


def test_findings_count_what_contests_say(table):
    row = rows_of(findings_table(table))["Is the chosen agent ahead of every classical controller?"]
    assert [each.verdict for each in contests(table)] == ["ahead"] * 6
    assert row["single fault"] == row["unseen"] == "ahead in 2 of 2, behind in 0" and row["other"] == "ahead in 1 of 1, behind in 0"
    behind = rows_of(findings_table(table_of(COSTS | {"mine-generalist": 0.7}, ("nominal", "solid"))))
    assert set(behind["Is the chosen agent ahead of every classical controller?"].values()) == {"ahead in 0 of 1, behind in 1"}


@pytest.mark.parametrize(("cost", "met"), [(0.5, "met"), (0.62, "missed"), (3.0, "missed")])
def test_findings_say_whether_a_generalist_meets_its_targets(cost, met):
    table = table_of(COSTS | {"mine-generalist": cost}, ("nominal", UNSEEN[0]))
    row = rows_of(findings_table(table))["Does mine-generalist meet its targets?"]
    single, unseen = reaches(table)
    assert row["single fault"].endswith(f": {met}") and single.met is (met == "met")
    assert row["unseen"].endswith(": missed" if cost > 2.0 else ": met") and unseen.met is (cost <= 2.0)


def test_the_first_sentence_of_the_findings_is_who_is_ahead(table, text):
    lead = text.partition("## Findings\n\n")[2].partition("\n\n")[0]
    counts = ("2 of 2 single fault", "1 of 1 open", "2 of 2 unseen", "1 of 1 other")
    told = "; in ".join(f"{each} scenarios, behind in 0" for each in counts)
    assert lead.endswith(f"is ahead of every classical controller in {told}.")
    assert lead.startswith("The agent chosen on validation seeds (where none was, the one with the least J on these very seeds")


def test_who_leads_a_tier_is_counted_split_by_split(table):
    row = rows_of(findings_table(table))["Who has the least J of tier 0, the nominal plant?"]
    assert row == {"single fault": "lqg in 2", "open": "lqg in 1", "unseen": "lqg in 2", "other": "no control in 1"}
    assert all(leaders_of(table)[name, 0].clear for name in ("nominal", "delay", "drift"))


def test_a_table_without_agents_has_no_question_about_them():
    laws = {name: cost for name, cost in COSTS.items() if name in ("none", "lqg")}
    text = page(table_of(laws, ("nominal",)), "beamenv benchmark")
    assert "Is the chosen agent" not in text and "Agents against classical" not in text and "Who has the least J of tier 0" in text
