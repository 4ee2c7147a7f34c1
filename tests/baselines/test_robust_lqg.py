"""LQG for a blade that is not quite as its model says: what it holds, what that costs, and that it knows of no scenario."""

import numpy as np
import pytest

import baselines.laws.robust_lqg as rule
from baselines import full_order_lqg, robust_lqg, stability_margins, stationary_cost
from baselines.design.modelling_errors import modelling_errors
from baselines.laws.detuning_search import shipped_detunings
from beamenv.blade.build import Blade
from beamenv.configuration.cache import key_of
from beamenv.task import resolve_task

SMALL = {"model": "thesis", "modes": 3, "beam": {"terms": 4}}


@pytest.fixture(name="design", scope="module")
def _design():
    return resolve_task(scenario="nominal").design


@pytest.fixture(name="law", scope="module")
def _law(design):
    return robust_lqg(design)


def test_it_holds_mistaken_blades_that_it_was_not_chosen_on_and_the_reference_does_not(design, law):
    plants, reference = modelling_errors(Blade(design.config), 12, seed=1000), full_order_lqg(design.full_plant)
    assert np.isfinite([stationary_cost(each, law) for each in plants]).all()
    assert np.isinf([stationary_cost(each, reference) for each in plants]).sum() >= 3


def test_its_margins_are_wider_and_it_costs_little_on_the_model(design, law):
    plant = design.full_plant
    reference = full_order_lqg(plant)
    assert stability_margins(plant, law).disk_margin > 2.0 * stability_margins(plant, reference).disk_margin
    assert stationary_cost(plant, reference) < stationary_cost(plant, law) < 1.07 * stationary_cost(plant, reference)


@pytest.mark.parametrize("scenario", ["failure", "off-speed", "solid"])
def test_it_knows_of_no_scenario(law, scenario):
    assert np.array_equal(robust_lqg(resolve_task(scenario=scenario).design).transition, law.transition)


@pytest.mark.parametrize("scenario", ["nominal", "hysteresis", "spillover"])
def test_what_ships_is_of_todays_blade(scenario):
    blade = Blade(resolve_task(scenario=scenario).design.config)
    assert key_of(*rule._depends_on(blade)) in shipped_detunings(rule.SHIPPED)


def test_what_was_chosen_costs_what_the_table_says(design):
    blade = Blade(design.config)
    with rule.SHIPPED.open(encoding="utf-8") as file:
        row = next(line for line in file if line.startswith("default,"))
    chosen = shipped_detunings(rule.SHIPPED)[key_of(*rule._depends_on(blade))]
    cost = rule.mean_cost(blade.truth, modelling_errors(blade, rule.PLANTS))(chosen)
    assert cost == pytest.approx(float(row.rpartition(",")[2]), abs=2e-4)


def test_for_another_blade_it_is_searched_once(tmp_path, monkeypatch):
    monkeypatch.setenv("BEAMENV_CACHE", str(tmp_path))
    monkeypatch.setattr(rule, "PLANTS", 3)
    monkeypatch.setattr(rule, "TRIALS", 4)
    design = resolve_task(blade=SMALL).design
    law = robust_lqg(design)
    assert len(list(tmp_path.glob("robust-lqg-*.json"))) == 1
    monkeypatch.setattr(rule, "searched_detuning", None)
    assert np.array_equal(robust_lqg(design).transition, law.transition)


def test_what_is_no_design_is_refused():
    with pytest.raises(ValueError, match="^design is None, but must be a beamenv.Design"):
        robust_lqg(None)
