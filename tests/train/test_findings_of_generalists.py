"""What findings say of generalists: nothing that was not measured, or that breaks a blade, meets a target."""

import json

import numpy as np
import pytest

from beamenv.scenarios.named import UNSEEN
from train.benchmark.cells import SERIES, Cell
from train.benchmark.listed import ListedController
from train.benchmark.showing.report import as_json
from train.benchmark.table import tabulate
from train.benchmark.targets import findings

AGENT = "mine-generalist"
UNCONTROLLED = np.random.default_rng(0).gamma(4.0, size=50)
BROKEN = np.where(np.arange(50) == 0, np.inf, 0.5)


def table_of(scenarios, missing=(), kind="learned", tier=1, **costs):
    """J / J₀ by controller, of every scenario alike; the agent could not be measured in ``missing`` ones."""
    kinds = {"agent": (AGENT, kind, tier), **{name: (name, "fixed", 0) for name in costs if name != "agent"}}
    listed = [ListedController(*kinds[name], {"": None}) for name in costs]
    cells = []
    for scenario in scenarios:
        for name, cost in costs.items():
            metrics = {each: np.zeros(50) for each in SERIES} | {"cost": cost * UNCONTROLLED}
            measured = {"uncontrolled": UNCONTROLLED, "fails": np.zeros(50), "metrics": metrics}
            lacks = name == "agent" and scenario in missing
            cells.append(Cell(scenario, kinds[name][0], "", **({"sentence": "It is not."} if lacks else measured)))
    return tabulate(cells, listed, {}, {"seeds": [0, 49], "versions": {}})


def told(table):
    """Those that have a target."""
    json.dumps(as_json(table), allow_nan=False)
    return [(each.met, each.sentence) for each in findings(table) if each.met is not None]


@pytest.mark.parametrize(
    ("agent", "law", "met", "end"),
    [
        (0.5, 0.5, True, "in 1 of 1 scenarios of a single fault (+0.0 % to +0.0 %)."),
        (0.5, BROKEN, True, "in 1 of 1 scenarios of a single fault (-100.0 % to -100.0 %)."),
        (BROKEN, 0.5, False, "in 0 of 1 scenarios of a single fault, but not in nominal (a blade breaks)."),
        (BROKEN, BROKEN, False, "in 0 of 1 scenarios of a single fault, but not in nominal (a blade breaks)."),
        (0.0, 0.5, True, "in 1 of 1 scenarios of a single fault (-100.0 % to -100.0 %)."),
        (0.0, 0.0, True, "in 1 of 1 scenarios of a single fault (+0.0 % to +0.0 %)."),
        (1.0304, 1.0, False, "in 0 of 1 scenarios of a single fault (+3.0 % to +3.0 %), but not in nominal +3.04 %."),
    ],
)
def test_a_generalist_that_breaks_a_blade_is_within_no_margin_even_where_laws_do(agent, law, met, end):
    ((verdict, sentence),) = told(table_of(["nominal"], lqg=law, agent=agent))
    assert verdict is met
    assert sentence.endswith(end)


def test_where_a_generalist_was_not_measured_it_meets_no_target():
    missing = ["delay", *UNSEEN[1:]]
    single, unseen = told(table_of(["nominal", "delay", *UNSEEN], missing, lqg=0.5, agent=0.5))
    assert single[0] is False
    assert single[1].endswith("in 1 of 2 scenarios of a single fault (+0.0 % to +0.0 %), but not in delay (not measured).")
    assert unseen[0] is False
    assert f"in 1 of {len(UNSEEN)} unseen scenarios, but not in {UNSEEN[1]} (not measured), " in unseen[1]


def test_shares_that_are_beyond_a_target_do_not_look_as_if_they_met_it():
    wild = np.where(np.arange(50) < 1, 3.0, 0.5)
    ((met, sentence),) = told(table_of([UNSEEN[0]], lqg=0.5, agent=wild))
    assert met and sentence.endswith("in 1 of 1 unseen scenarios.")
    more = np.stack([wild, np.where(np.arange(50) < 2, 3.0, 0.5)])
    table = table_of([UNSEEN[0]], lqg=0.5, agent=0.5)
    listed = [ListedController(AGENT, "learned", 1, {"0": None, "1": None})]
    metrics = [{each: np.zeros(50) for each in SERIES} | {"cost": cost * UNCONTROLLED} for cost in (more[0], more[1])]
    cells = [
        Cell(UNSEEN[0], AGENT, run, uncontrolled=UNCONTROLLED, fails=np.zeros(50), metrics=each)
        for run, each in zip("01", metrics, strict=True)
    ]
    ((met, sentence),) = told(tabulate(cells, listed, {}, table.configuration))
    assert not met and sentence.endswith(f"in 0 of 1 unseen scenarios, but not in {UNSEEN[0]} 3 %.")


@pytest.mark.parametrize(("kind", "tier"), [("own", 1), ("learned", 2)])
def test_who_is_told_more_or_is_the_callers_own_is_no_generalist_whatever_its_name(kind, tier):
    assert told(table_of(["nominal", UNSEEN[0]], kind=kind, tier=tier, lqg=0.5, agent=0.5)) == []
    assert told(table_of(["white"], lqg=0.5, agent=0.5)) == []
