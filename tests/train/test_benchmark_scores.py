"""Scores against hand computation, SciPy, a bootstrap written out in loops, and known truths of synthetic costs."""

import numpy as np
import pytest
from scipy.stats import trim_mean

from baselines.evaluation.metrics import EpisodeMetrics
from beamenv.scenarios.named import BENCHMARK, NAMES, OPEN, UNSEEN
from train.benchmark.cells import SERIES, Cell
from train.benchmark.listed import ListedController
from train.benchmark.score import SPLITS, aggregates, headrooms
from train.benchmark.showing.report import as_json, markdown
from train.benchmark.statistics import over_scenarios, scores, summary
from train.benchmark.table import tabulate

UNCONTROLLED = np.array([2.0, 4.0, 6.0, 8.0])
REFERENCE = np.array([[1.0, 2.0, 3.0, 2.0]])  # mean 2 of 5: 3 can be gained


def costs_of(seed, scenarios, runs, seeds=40, by_run=0.05, shared=0.3):
    """J (S, K, N), J₀ and J of the reference (S, N): a seed's load is the same in every scenario, a run's error its own."""
    generator = np.random.default_rng(seed)
    load = np.exp(shared * generator.normal(size=seeds))
    uncontrolled = load * np.exp(0.1 * generator.normal(size=(scenarios, seeds)))
    level = np.linspace(0.45, 0.8, scenarios)[:, None, None] + 0.3 * (load - np.exp(0.5 * shared**2))
    cost = uncontrolled[:, None] * (level + by_run * generator.normal(size=(scenarios, runs, 1)))
    return cost, uncontrolled, 0.4 * uncontrolled


def interval_of(cost, uncontrolled, reference, apart=False):
    """The aggregate's estimate; with ``apart``, as if each scenario had seeds of its own."""
    found = []
    for index in range(len(cost)):
        own = scores(cost[index], reference[index][None], uncontrolled[index], str(index))
        if apart:
            own = np.concatenate([own[:1], np.random.default_rng(index).permutation(own[1:])])
        found.append(own)
    return summary(over_scenarios(found))


def test_no_control_scores_zero_and_the_reference_one_and_half_of_the_gain_a_half():
    def scored(cost):
        estimate = summary(scores(np.atleast_2d(cost), REFERENCE, UNCONTROLLED))
        return estimate.value, estimate.low, estimate.high

    assert scored(UNCONTROLLED) == (0.0, 0.0, 0.0)
    assert scored(REFERENCE) == (1.0, 1.0, 1.0)
    assert scored(0.5 * (UNCONTROLLED + REFERENCE)) == pytest.approx((0.5, 0.5, 0.5))
    assert scored([[5.0, 5.0, 5.0, 1.0], [3.0, 5.0, 3.0, 1.0]])[0] == pytest.approx((5.0 - 3.5) / 3.0)


def test_what_beats_the_reference_scores_above_one_and_what_feeds_vibration_below_zero():
    assert summary(scores(REFERENCE - 0.5, REFERENCE, UNCONTROLLED)).value == pytest.approx(3.5 / 3.0)
    assert summary(scores(UNCONTROLLED[None] + 6.0, REFERENCE, UNCONTROLLED)).value == pytest.approx(-2.0)


def test_a_blade_that_a_law_breaks_makes_its_score_infinitely_low():
    lost = summary(scores(np.array([[1.0, np.inf, 1.0, 1.0]]), REFERENCE, UNCONTROLLED))
    assert (lost.value, lost.low) == (-np.inf, -np.inf)
    assert lost.high > 0.0  # some resamples do not draw it


@pytest.mark.parametrize(
    "reference", [UNCONTROLLED, UNCONTROLLED + [0.0, 0.0, 0.0, -9e-9], [1.0, np.inf, 1.0, 1.0], [9.0, 1.0, 1.0, 1.0]]
)
def test_without_a_clear_gain_of_the_reference_there_is_no_score(reference):
    assert scores(np.ones((1, 4)), np.array([reference]), UNCONTROLLED) is None


@pytest.mark.parametrize("scenarios", [1, 2, 4, 9, 10])
def test_the_aggregate_is_scipys_mean_of_what_a_quarter_cut_off_at_either_end_leaves(scenarios):
    cost, uncontrolled, reference = costs_of(3, scenarios, runs=5)
    by_hand = [(uncontrolled[s].mean() - cost[s].mean()) / (uncontrolled[s].mean() - reference[s].mean()) for s in range(scenarios)]
    assert interval_of(cost, uncontrolled, reference).value == pytest.approx(trim_mean(by_hand, 0.25), rel=1e-12)


def test_a_quarter_of_scenarios_with_broken_blades_does_not_sink_the_aggregate_and_more_does():
    cost, uncontrolled, reference = costs_of(4, 8, runs=1)
    cost[:2, 0, 0] = np.inf
    assert np.isfinite(interval_of(cost, uncontrolled, reference).value)
    cost[2, 0, 0] = np.inf
    assert interval_of(cost, uncontrolled, reference).value == -np.inf


def test_the_interval_is_that_of_a_bootstrap_written_out():
    """Runs drawn within each scenario, seeds together for all of them."""
    cost, uncontrolled, reference = costs_of(5, 6, runs=4)
    generator, drawn = np.random.default_rng(11), []
    for _ in range(1500):
        seeds, found = generator.choice(40, size=40), []
        for s in range(6):
            j = cost[s][generator.choice(4, size=4)][:, seeds].mean()
            j0, jc = uncontrolled[s, seeds].mean(), reference[s, seeds].mean()
            found.append((j0 - j) / (j0 - jc))
        drawn.append(sum(sorted(found)[1:-1]) / 4)
    low, high = np.quantile(drawn, [0.025, 0.975])
    ours = interval_of(cost, uncontrolled, reference)
    assert (ours.low, ours.high) == pytest.approx((low, high), abs=0.1 * (high - low))


def test_19_of_20_intervals_hold_the_truth_as_seeds_are_drawn_together_and_fewer_would_if_they_were_not():
    """The truth from the moments of a log-normal load: E[load²] / E[load] = exp(1.5 σ²), E[load] = exp(0.5 σ²)."""
    truth = (1.0 - 0.625 - 0.3 * (np.exp(1.5 * 0.3**2) - np.exp(0.5 * 0.3**2))) / 0.6
    held, apart = 0, 0
    for seed in range(100, 250):
        drawn = costs_of(seed, 4, 10)
        together, alone = interval_of(*drawn), interval_of(*drawn, apart=True)
        held, apart = held + (together.low <= truth <= together.high), apart + (alone.low <= truth <= alone.high)
    assert 0.90 < held / 150 < 0.985
    assert apart / 150 < 0.85


def test_runs_of_one_policy_are_drawn_together_for_all_scenarios():
    """Their error does not average out over scenarios, as that of trainings of their own does."""
    generator = np.random.default_rng(9)
    error = 0.1 * generator.normal(size=(12, 1))
    rates = {
        "same": [scores(np.full((12, 30), 0.7) + error, np.full((1, 30), 0.4), np.ones(30)) for _ in range(8)],
        "own": [
            scores(np.full((12, 30), 0.7) + generator.permutation(error), np.full((1, 30), 0.4), np.ones(30), str(scenario))
            for scenario in range(8)
        ],
    }
    width = {name: (each := summary(over_scenarios(found))).high - each.low for name, found in rates.items()}
    assert width["same"] == pytest.approx(2 * 1.96 * (error / 0.6).std() / np.sqrt(12), rel=0.08)
    assert width["own"] < 0.6 * width["same"]


def table_of(costs, homes=None):
    """A table of J by controller, the same in every scenario but for a scenario's own factor."""
    tiers = {"none": 0, "lqg": 0, "clairvoyant": 3}
    listed = [ListedController(name, "fixed", tiers.get(name, 1), {"": None}) for name in costs]
    scenarios = homes or {name: tuple(costs) for name in ("delay", "failure", "nominal", "drift", "solid")}
    cells = []
    for scenario, names in scenarios.items():
        for name in costs:
            if name in names:
                metrics = {each: np.zeros(4) for each in SERIES} | {"cost": costs[name] * UNCONTROLLED}
                cells.append(Cell(scenario, name, "", uncontrolled=UNCONTROLLED, fails=np.zeros(4), metrics=metrics))
            elif name == "clairvoyant":
                cells.append(Cell(scenario, name, "", sentence="truth has plants that wander"))
    return tabulate(cells, listed, {}, {"seeds": [0, 3], "versions": {}})


COSTS = {"none": 1.0, "lqg": 0.7, "rival": 0.6, "clairvoyant": 0.4}


def test_every_scenario_that_ships_is_of_one_split():
    assert sorted(name for names in SPLITS.values() for name in names) == sorted(NAMES)
    assert set(SPLITS["open"]) == set(OPEN) and set(SPLITS["unseen"]) == set(UNSEEN)
    assert set(SPLITS["single fault"]) < set(BENCHMARK)


def test_a_split_stands_on_the_scenarios_in_which_there_is_a_score_and_says_which():
    homes = {name: tuple(COSTS) for name in ("delay", "failure", "solid")} | {"drift": ("none", "lqg", "rival")}
    homes["gust-speed"] = homes["drift"]
    homes["mid-failure"] = tuple(COSTS)
    found = {(each.split, each.controller): each for each in aggregates(table_of(COSTS, homes))}
    assert {split for split, _ in found} == {"single fault", "open", "unseen"}
    one = found["open", "rival"]
    assert (one.scenarios, one.without) == (("mid-failure",), ("drift", "gust-speed"))
    assert one.score.value == pytest.approx(0.4 / 0.6)
    assert (one.less_lqg.value, one.less_lqg.low, one.less_lqg.high) == pytest.approx((1 / 6, 1 / 6, 1 / 6))
    text = markdown(table_of(COSTS, homes))
    assert "open, 1 of 4 scenarios" in text
    assert "- open: mid-failure; without a score: drift, gust-speed." in text


def test_who_is_at_home_in_some_scenarios_has_no_score_over_all():
    homes = {"delay": tuple(COSTS), "failure": ("none", "lqg", "clairvoyant")}
    assert "rival" not in {each.controller for each in aggregates(table_of(COSTS, homes))}


def test_headroom_is_from_the_best_that_is_not_told_the_truth_to_what_is():
    (one,) = headrooms(table_of(COSTS, {"delay": tuple(COSTS)}))
    assert one.best.controller == "rival"
    assert one.cost.value == pytest.approx(0.2)
    assert one.score.value == pytest.approx(1.0 - 0.4 / 0.6)
    (none,) = headrooms(table_of(COSTS | {"rival": 0.3}, {"delay": tuple(COSTS)}))
    assert none.cost.value == pytest.approx(-0.1) and none.score.value < 0.0


def test_without_the_clairvoyant_law_there_is_no_score():
    table = table_of({name: cost for name, cost in COSTS.items() if name != "clairvoyant"})
    assert not aggregates(table) and not headrooms(table)
    assert all("score" not in row.estimates for row in table.rows)
    assert "Score over scenarios" not in markdown(table)


def test_a_file_that_has_a_scenarios_name_but_is_another_is_of_no_split():
    table = table_of(COSTS, {"delay": tuple(COSTS)})
    table.configuration["scenarios"] = {"delay": {"drive": {"delay": [9, 9]}}}
    assert aggregates(table) == []


def test_aggregates_and_headroom_are_in_the_file_for_programs():
    content = as_json(table_of(COSTS | {"rival": np.array([0.5, np.inf, 0.5, 0.5])}))
    rival = next(each for each in content["aggregates"] if (each["split"], each["controller"]) == ("unseen", "rival"))
    assert rival["score"]["value"] is None and rival["scenarios"] == ["solid"]
    assert {each["scenario"]: each["best"]["controller"] for each in content["headroom"]}["solid"] == "lqg"
    assert set(EpisodeMetrics.__dataclass_fields__) <= set(content["rows"][0]["estimates"])
