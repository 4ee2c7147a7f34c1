"""Who stands for agents and laws, and when one is ahead of the other."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.scenarios.named import UNSEEN
from train.benchmark import benchmark, choice
from train.benchmark import choose as tool
from train.benchmark.cells import SERIES, Cell, sources_digest
from train.benchmark.choice import SCENARIOS, Choice, choose, read_choice, write_choice
from train.benchmark.contests import AHEAD, BEHIND, LEVEL, STALE, contests_by, corrected
from train.benchmark.listed import ListedController
from train.benchmark.showing.report import markdown
from train.benchmark.table import tabulate
from train.benchmark.targets import leader, leading
from train.controllers.named import named
from train.shared.held_out import VALIDATION, validation

SEEDS = 32
UNCONTROLLED = np.random.default_rng(0).gamma(4.0, size=SEEDS)
KINDS = {"none": ("fixed", 0), "lqg": ("fixed", 0), "scheduled": ("scheduled", 2), "told": ("fixed", 1), "mine": ("own", 1)}


def table_of(costs, scenarios=("delay",), seeds=(1_000_000, 1_000_000 + SEEDS - 1)):
    """J / J₀ by controller, of every scenario alike; agents are those whose name begins with one."""
    listed = [ListedController(name, *KINDS.get(name, ("learned", 1)), {"": None}) for name in costs]
    cells = [
        Cell(
            scenario,
            name,
            "",
            uncontrolled=UNCONTROLLED,
            fails=np.zeros(SEEDS),
            metrics={each: np.zeros(SEEDS) for each in SERIES} | {"cost": costs[name] * UNCONTROLLED},
        )
        for scenario in scenarios
        for name in costs
    ]
    return tabulate(cells, listed, {}, {"seeds": list(seeds), "versions": {}})


def noise(seed):
    return 0.2 * np.random.default_rng(seed).normal(size=SEEDS)


COSTS = {"none": 1.0, "lqg": 0.6, "told": 0.55, "scheduled": 0.3, "mine": 0.2, "agent-a": 0.5, "agent-b": 0.52}
CHOSEN = Choice(VALIDATION, 8, "", {"delay": "agent-b"}, {"delay": "lqg"}, {"agents": "agent-a", "laws": "told"})


def test_who_was_chosen_stands_even_where_another_does_better_on_these_seeds():
    (one,) = contests_by(table_of(COSTS), CHOSEN)
    assert (one.agent.controller, one.agent_chosen) == ("agent-b", True)
    assert (one.law.controller, one.law_chosen) == ("lqg", True)
    assert one.gap.value == pytest.approx(-0.08)


def test_who_is_told_more_or_is_the_callers_own_is_no_rival_of_agents():
    (one,) = contests_by(table_of(COSTS), CHOSEN)
    assert one.verdict == AHEAD
    assert (one.hardest.controller, one.least_clear.value) == ("told", pytest.approx(-0.03))


def test_an_agent_that_is_told_more_than_laws_does_not_stand_for_agents(monkeypatch):
    monkeypatch.setitem(KINDS, "agent-fast", ("learned", 2))
    (one,) = contests_by(table_of(COSTS | {"agent-fast": 0.1}), None)
    assert one.agent.controller == "agent-a"


def test_an_agent_is_ahead_only_of_all_laws_and_behind_only_where_all_agents_are():
    def verdict(**changes):
        return contests_by(table_of(COSTS | changes), CHOSEN)[0].verdict

    assert verdict(told=0.52 + noise(1)) == LEVEL
    assert verdict(told=0.51) == LEVEL  # below the chosen agent, above the other one; and not the law that was chosen
    assert verdict(lqg=0.51) == LEVEL
    assert verdict(lqg=0.49) == BEHIND
    assert verdict(told=np.full(SEEDS, np.inf), lqg=np.full(SEEDS, np.inf)) == AHEAD


def test_an_agent_that_is_not_behind_is_overtaken_where_a_law_that_nobody_chose_is_below_it():
    def found(**changes):
        (one,) = contests_by(table_of(COSTS | changes), CHOSEN)
        return one.verdict, one.overtaken

    assert found(told=0.51) == (LEVEL, True)
    assert found(lqg=0.49) == (BEHIND, True)
    assert found() == (AHEAD, False)


def test_a_verdict_of_one_scenario_may_not_be_left_when_many_are_judged_together():
    weak = table_of({"none": 1.0, "lqg": 0.6, "agent-a": 0.53 + 0.5 * (noise(3) - noise(3).mean())})
    (alone,) = contests_by(weak, None)
    assert alone.verdict == AHEAD and 0.0 < alone.doubt < 0.05
    assert corrected([alone]) == [AHEAD]
    level = [replace(alone, verdict=LEVEL, doubt=1.0)] * 23
    assert corrected([*level, alone]) == [LEVEL] * 24
    (clear,) = contests_by(table_of({"none": 1.0, "lqg": 0.6, "agent-a": 0.5}), None)
    assert corrected([*level, clear])[-1] == AHEAD


def test_without_a_choice_the_least_stands_and_is_marked():
    (one,) = contests_by(table_of(COSTS), None)
    assert (one.agent.controller, one.law.controller) == ("agent-a", "told")
    assert not one.agent_chosen and not one.law_chosen


def test_nobody_is_chosen_on_scenarios_kept_for_judging():
    assert not set(SCENARIOS) & set(UNSEEN)
    (one,) = contests_by(table_of(COSTS, ["long-delay"]), CHOSEN)
    assert (one.agent.controller, one.law.controller) == ("agent-a", "told")
    (other,) = contests_by(table_of(COSTS, ["failure"]), CHOSEN)
    assert not other.agent_chosen  # it could have been chosen on, and was not


def test_the_choice_is_the_least_of_each_scenario_and_of_all_together(tmp_path):
    first = table_of(COSTS, ["delay"], (VALIDATION, VALIDATION + SEEDS - 1))
    second = table_of(COSTS | {"agent-b": 0.3, "lqg": 0.45}, ["failure"], (VALIDATION, VALIDATION + SEEDS - 1))
    both = type(first)(first.rows + second.rows, {}, first.configuration)
    found = choose(both)
    assert (found.first, found.seeds) == (VALIDATION, SEEDS)
    assert found.agents == {"delay": "agent-a", "failure": "agent-b"}
    assert found.laws == {"delay": "told", "failure": "lqg"}
    assert found.everywhere == {"agents": "agent-b", "laws": "lqg"}
    write_choice(tmp_path / "chosen.json", found)
    assert read_choice(tmp_path / "chosen.json") == found
    assert read_choice(tmp_path / "none.json") is None


def test_no_law_that_is_made_of_a_scenario_stands_for_laws_where_it_is_told_of_none(monkeypatch):
    monkeypatch.setitem(KINDS, "multiple-model-general", ("adaptive", 1))
    table = table_of({"none": 1.0, "lqg": 0.6, "told": 0.4, "multiple-model-general": 0.5, "agent-a": 0.55})
    assert choose(table).laws == {"delay": "told"}
    assert choose(table).everywhere == {"agents": "agent-a", "laws": "multiple-model-general"}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ('"agents": {"long-delay": "a"}', "choice.agents has no field 'long-delay'"),
        ('"laws": {"delay": 3}', "choice.laws.delay is 3"),
        ('"first": "x"', "choice.first is 'x'"),
    ],
)
def test_a_file_that_is_no_choice_is_refused_by_name(change, sentence, tmp_path):
    path = tmp_path / "chosen.json"
    whole = {"first": '"first": 1', "seeds": '"seeds": 8', "digest": '"digest": ""'}
    whole[change.split('"')[1]] = change
    path.write_text("{" + ", ".join(whole.values()) + "}")
    with pytest.raises(ValueError, match="chosen.json") as refusal:
        read_choice(path)
    assert sentence in str(refusal.value)


def test_validation_measures_on_seeds_that_no_table_is_made_of():
    short = {"scenarios": ["nominal"], "controllers": [], "seeds": 3, "environment": {"duration": 0.02}}
    chosen_on = benchmark(**short, validation=True)
    assert chosen_on.configuration["seeds"] == [VALIDATION, VALIDATION + 2] == [validation(3)[0], validation(3)[-1]]
    judged_on = benchmark(**short)
    assert not np.array_equal(chosen_on.rows[0].uncontrolled, judged_on.rows[0].uncontrolled)


def test_the_tool_writes_who_is_chosen(tmp_path, monkeypatch):
    monkeypatch.setattr(tool, "benchmark", lambda **given: table_of(COSTS, given["scenarios"]))
    made = tool.main(["--to", str(tmp_path / "chosen.json"), "--scenario", "delay", "--folder", str(tmp_path / "cells")])
    assert read_choice(tmp_path / "chosen.json") == made
    assert made.agents == {"delay": "agent-a"}


def test_the_leader_of_a_tier_is_of_any_kind_and_clear_only_by_every_paired_interval():
    rows = table_of(COSTS).rows
    first = leader(rows, 1)
    assert (first.row.kind, first.rivals, first.clear) == ("own", 3, True)
    assert not leader(table_of(COSTS | {"mine": 0.49 + noise(2)}).rows, 1).clear
    assert leader(rows, 0).clear and not leader(rows, 2).clear
    assert leader(rows, 3) is None
    assert leading(table_of(COSTS), 0) == "Tier 0, the nominal plant: least J of 1 scenarios by lqg in 1, clearly in 1."
    assert leading(table_of(COSTS), 2).endswith("by scheduled in 1, alone.")


def test_tables_say_who_was_not_chosen_and_that_this_favours_it():
    text = markdown(table_of(COSTS, ["gusty"]))
    assert text.count("A name in brackets was not chosen: it has the least J on these very seeds, which favours it.") == 1
    assert "| gusty | (agent-a) | (told) |" in text


@pytest.mark.parametrize("today", [True, False])
def test_a_choice_made_with_other_code_is_told(monkeypatch, today):
    made = Choice(VALIDATION, SEEDS, sources_digest() if today else "1" * 16)
    monkeypatch.setattr(choice, "read_choice", lambda: made)
    assert markdown(table_of(COSTS, ["gusty"])).count(STALE) == int(not today)


def test_names_in_the_choice_that_ships_exist():
    shipped = read_choice()
    for name in () if shipped is None else {*shipped.laws.values(), shipped.everywhere["laws"]}:
        assert named(name).tier <= 1
