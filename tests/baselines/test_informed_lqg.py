"""LQG detuned for a scenario: delays in the plant, what designs are told, the rule that chooses, and what it ships with."""

import math
from dataclasses import replace

import numpy as np
import pytest

import beamenv
from baselines import Detuning, PersistentLoad, detuned_lqg, full_order_lqg, informed_lqg, lqg, stationary_cost
from baselines.design.delay import with_delay
from baselines.laws import informed_lqg as rule
from baselines.laws.detuning_search import shipped_detunings
from beamenv.configuration.cache import key_of
from beamenv.plant.plant import sample
from beamenv.task import resolve_task

SMALL = {"model": "thesis", "modes": 3, "beam": {"terms": 4}}


def test_a_delayed_plant_moves_as_voltages_of_before_would_move_it(small_plant):
    """Its cost is that of the voltages that act, but for half of their own price, which is charged when they are asked for."""
    held, late = sample(small_plant()), with_delay(sample(small_plant()), 2)
    asked, loads = np.random.default_rng(0).normal(size=(12, 2)), np.random.default_rng(1).normal(size=(12, 2))
    asked[9:] = 0.0  # all that was asked for acts within the time
    state, both, cost, same = np.zeros(len(held.A)), np.zeros(len(late.A)), 0.0, 0.0
    for k in range(12):
        acting = asked[k - 2] if k >= 2 else np.zeros(2)
        z, zz = np.concatenate([state, acting, loads[k]]), np.concatenate([both, asked[k], loads[k]])
        cost, same = cost + z @ held.cost @ z, same + zz @ late.cost @ zz
        state = held.A @ state + held.B @ acting + held.disturbance_input @ loads[k]
        both = late.A @ both + late.B @ asked[k] + late.disturbance_input @ loads[k]
        assert both[: len(state)] == pytest.approx(state, rel=1e-12, abs=1e-15)
    assert same == pytest.approx(cost, rel=1e-12)


def test_the_law_of_each_delay_is_the_best_there_is_at_that_delay(small_plant):
    plant = small_plant()
    laws = [detuned_lqg(plant, Detuning(delay=d, rate=0.0)) for d in range(4)]
    costs = np.array([[stationary_cost(with_delay(sample(plant), d), law) for law in laws] for d in range(4)])
    assert costs.argmin(axis=1).tolist() == [0, 1, 2, 3]
    assert np.all(np.diff(np.diag(costs)) > 0.0)
    generator = np.random.default_rng(0)
    for d, law in enumerate(laws):
        other = replace(law, state_gain=law.state_gain * (1.0 + 0.01 * generator.standard_normal(law.state_gain.shape)))
        assert stationary_cost(with_delay(sample(plant), d), other) > costs[d, d]


def test_told_nothing_else_it_is_the_reference_of_full_order(small_plant):
    plant = small_plant()
    for detuned, known in (
        (detuned_lqg(plant, Detuning()), full_order_lqg(plant)),
        (detuned_lqg(plant, Detuning(rate=0.0)), lqg(plant)),
        (detuned_lqg(plant, Detuning(foresees=True), PersistentLoad()), full_order_lqg(plant, load=PersistentLoad())),
    ):
        assert detuned.state_gain == pytest.approx(known.state_gain, rel=1e-9, abs=1e-9 * np.abs(known.state_gain).max())
        assert detuned.transition == pytest.approx(known.transition, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("change", [{"effort": 4.0}, {"rate": 30.0}, {"noise": 5.0}])
def test_what_makes_voltages_dear_or_readings_doubtful_makes_the_law_gentler(small_plant, change):
    gentle, bold = (detuned_lqg(small_plant(), each) for each in (Detuning(**change), Detuning()))
    assert np.linalg.norm(gentle.measurement_gain) < np.linalg.norm(bold.measurement_gain)


def test_a_coordinate_search_finds_the_bottom_of_a_bowl():
    def bowl(each):
        parts = (each.delay - 3, math.log(each.rate / 9.0), math.log(each.noise / 0.5), math.log(each.effort), each.foresees)
        return 1.0 + sum(float(part) ** 2 for part in parts)

    best, tried = rule.coordinate_search(bowl, Detuning(delay=1, foresees=True), True)
    assert (best.delay, best.foresees) == (3, False)
    assert (best.rate, best.noise, best.effort) == pytest.approx((9.0, 0.5, 1.0))
    assert tried[best] == min(tried.values())
    assert len(tried) <= rule.TRIALS


def test_what_was_chosen_is_kept_for_the_next_time_and_for_nothing_else(tmp_path, monkeypatch):
    monkeypatch.setenv("BEAMENV_CACHE", str(tmp_path))
    monkeypatch.setattr(rule, "EPISODES", 4)
    monkeypatch.setattr(rule, "TRIALS", 3)
    task = resolve_task(blade=SMALL, scenario="delay", duration=0.05)
    law = informed_lqg(task.prior)
    assert len(list(tmp_path.glob("informed-lqg-*.json"))) == 1
    monkeypatch.setattr(rule, "searched_detuning", None)
    again = informed_lqg(resolve_task(blade=SMALL, scenario="delay", duration=0.05).prior)
    assert np.array_equal(again.transition, law.transition)
    with pytest.raises(TypeError):  # another scenario is searched for anew
        informed_lqg(resolve_task(blade=SMALL, scenario="failure", duration=0.05).prior)
    assert "bank" not in vars(task)  # the plants that judge were not even built


@pytest.mark.parametrize("name", sorted({*beamenv.BENCHMARK_SCENARIOS, *beamenv.OPEN_SCENARIOS} - {*beamenv.UNSEEN_SCENARIOS}))
def test_what_ships_is_of_todays_blade_and_scenarios(name):
    prior = resolve_task(scenario=name).prior
    assert key_of(*rule._depends_on(prior)) in shipped_detunings(rule.SHIPPED)


def test_what_ships_costs_on_the_episodes_of_tuning_what_it_says():
    prior = resolve_task(scenario="delay").prior
    with rule.SHIPPED.open(encoding="utf-8") as file:
        row = next(line for line in file if line.startswith("delay,"))
    assert rule._cost(prior)(rule.chosen_detuning(prior)) == pytest.approx(float(row.rpartition(",")[2]), abs=2e-3)


def test_what_is_no_prior_is_refused():
    with pytest.raises(ValueError, match="prior is .*, but must be a beamenv.Prior"):
        informed_lqg(beamenv.scenario("delay"))
