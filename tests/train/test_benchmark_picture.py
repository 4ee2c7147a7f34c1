"""Who is in the benchmark's picture, and in which panel."""

import numpy as np

from train.benchmark.cells import SERIES, Cell
from train.benchmark.listed import ListedController, place
from train.benchmark.showing.heat_map import MOST, heat_map, shown
from train.benchmark.showing.report import markdown
from train.benchmark.table import tabulate

SEEDS = 4
LAWS = {
    "none": ("fixed", 0, 1.0),
    "lqg": ("fixed", 0, 0.6),
    "lqg-load": ("fixed", 0, 0.5),
    "velocity": ("fixed", 0, 0.9),
    "mpc": ("predictive", 0, 0.7),
    "informed-lqg": ("fixed", 1, 0.5),
    "other-informed": ("fixed", 1, 0.55),
    "multiple-model": ("adaptive", 1, 0.45),
    "scheduled-lqg": ("scheduled", 2, 0.5),
    "lqr": ("fixed", 3, 0.3),
    "clairvoyant": ("scheduled", 3, 0.4),
}
AGENTS = {f"agent-{k}-generalist": ("learned", 1, 0.5 + 0.01 * k) for k in range(9)} | {
    "brief-specialist": ("learned", 1, 0.2),
    "wide-specialist": ("learned", 1, 0.6),
}


def table_of(controllers, scenarios):
    """J / J₀ alike in all scenarios; the brief specialist is at home in the first alone."""
    listed = [ListedController(name, kind, tier, {"": None}) for name, (kind, tier, _) in controllers.items()]
    metrics = {name: np.zeros(SEEDS) for name in SERIES}
    cells = [
        Cell(scenario, name, "", "", "", np.ones(SEEDS), np.zeros(SEEDS), metrics | {"cost": np.full(SEEDS, cost)})
        for scenario in scenarios
        for name, (_, _, cost) in controllers.items()
        if name != "brief-specialist" or scenario == scenarios[0]
    ]
    ordered = sorted(listed, key=lambda each: place(each.tier, each.kind))
    return tabulate(cells, ordered, {}, {"seeds": [0, SEEDS - 1], "versions": {}})


def test_a_small_table_is_shown_whole_but_for_no_control():
    few = {name: each for name, each in LAWS.items() if name != "velocity"}
    assert set(shown(table_of(few, ["delay"]))) == set(few) - {"none"}


def test_of_a_large_one_lqg_the_clairvoyant_the_best_of_each_tier_and_generalists_are_shown():
    names = shown(table_of(LAWS | AGENTS, ["delay", "failure"]))
    assert len(names) == MOST
    assert set(names) & set(LAWS) == {"lqg", "lqg-load", "multiple-model", "scheduled-lqg", "clairvoyant"}
    assert [name for name in names if name in AGENTS] == [f"agent-{k}-generalist" for k in range(4)]


def test_the_caller_s_own_are_shown_however_they_fare():
    names = shown(table_of(LAWS | AGENTS | {"mine": ("own", 1, 3.0)}, ["delay", "failure"]))
    assert len(names) == MOST and "mine" in names


def test_panels_are_the_splits_and_the_bold_one_is_the_best_of_those_shown_that_are_not_told_the_truth():
    content = heat_map(table_of(LAWS | AGENTS, ["solid", "gusty", "drift", "nominal", "delay"]))
    assert content.groups == ("single fault", "single fault", "open", "unseen", "other")
    assert content.scenarios == ("nominal", "delay", "drift", "solid", "gusty")
    assert content.best == ("multiple-model",) * 5
    assert content.kinds == tuple(sorted(content.kinds))


def test_the_tables_below_have_everyone_split_by_split():
    text = markdown(table_of(LAWS | AGENTS, ["solid", "delay"]))
    single, unseen = (text.split(f"### J / J₀: {split}")[1].split("###")[0] for split in ("single fault", "unseen"))
    for name in LAWS | AGENTS:
        assert (f"| {name} |" in unseen) and (f"| {name} |" in single or name == "brief-specialist")
