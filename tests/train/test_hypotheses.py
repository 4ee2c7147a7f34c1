"""What a multiple-model controller holds possible is what its scenario may draw, and nothing of what is kept for judging."""

import numpy as np
import pytest

from baselines import MultipleModel, RotorHarmonics
from baselines.laws.foreseen_load import foreseen_loads
from beamenv.scenarios.drawing import load_cases
from beamenv.task import resolve_task
from train.controllers import hypotheses as rule
from train.controllers.hypotheses import are_drawn, hypotheses_of, switches
from train.controllers.named import named


def prior_of(scenario):
    return resolve_task(scenario=scenario, blade={"model": "thesis"}, duration=0.1).prior


def kinds(hypotheses):
    """(actuators, sensors, which are biased) of each."""
    return {(tuple(each.actuator_gain), tuple(each.sensor_gain), tuple(each.sensor_bias > 0.0)) for each in hypotheses}


def test_faults_are_those_that_episodes_draw_and_no_others():
    prior = prior_of("failure")
    drawn = prior.hypotheses(600).faults
    each = zip(drawn.actuator_gain, drawn.sensor_gain, drawn.sensor_bias != 0.0, strict=True)
    held = hypotheses_of(prior)
    assert len(held) == 32
    assert kinds(held) == {(tuple(a), tuple(s), tuple(b)) for a, s, b in each}
    assert sum(one.prior for one in held) == pytest.approx(1.0)
    spread = np.sqrt(np.mean(drawn.sensor_bias[drawn.sensor_bias != 0.0] ** 2))
    assert max(one.sensor_bias.max() for one in held) == pytest.approx(spread, rel=0.05)
    assert switches(prior, held) is None


def test_delays_are_those_that_may_be_drawn_and_lost_readings_are_known():
    held = hypotheses_of(prior_of("delay"))
    assert [(each.delay, each.holds_lost_readings) for each in held] == [(1, True), (2, True), (3, True)]


def test_two_dead_actuators_are_neighbours_in_the_ring():
    held = hypotheses_of(prior_of({"failures": {"dead_actuators": 2, "remaining": [0.2, 0.4]}}))
    rings = {tuple(np.round(each.actuator_gain, 12)) for each in held}
    assert rings == {(0.3, 0.3, 1.0, 1.0), (1.0, 0.3, 0.3, 1.0), (1.0, 1.0, 0.3, 0.3), (0.3, 1.0, 1.0, 0.3)}


def test_what_breaks_within_the_episode_is_whole_at_the_start_and_stays_broken():
    prior = prior_of("mid-failure")
    held = hypotheses_of(prior)
    matrix = switches(prior, held)
    assert len(held) == 9
    assert held[0].actuator_gain.all() and held[0].sensor_gain.all()
    assert held[0].prior > 1e4 * sum(each.prior for each in held[1:])
    np.testing.assert_array_equal(matrix[1:, 1:], np.eye(8))
    assert not matrix[1:, 0].any()
    np.testing.assert_allclose(matrix[0, 1:], 0.0005 / 0.175 / 8)
    both = hypotheses_of(
        prior_of({"failures": {"dead_actuators": 1, "faulty_sensors": 1, "biased_share": 0.0, "onset": [0.0, 0.1]}})
    )
    assert len(both) == len(kinds(both)) == 25


def test_plants_are_of_the_training_seed_and_none_that_judge(monkeypatch):
    monkeypatch.setattr(rule, "PLANTS", 5)
    scenario = {"plants": {"speed_ratio": [0.9, 1.1], "bank": 5}}
    held, task = hypotheses_of(prior_of(scenario)), resolve_task(scenario=scenario, blade={"model": "thesis"}, duration=0.1)
    firsts = {each.plant.natural_frequencies[0] for each in held}
    assert len(firsts) == 5
    np.testing.assert_array_equal(np.sort(list(firsts)), np.sort([first_of(s) for s in task.prior.bank.speeds]))
    assert not firsts & {first_of(speed) for speed in task.bank.speeds}


def first_of(speed):
    return resolve_task(blade={"model": "thesis"}, speed=float(speed)).plant.natural_frequencies[0]


def test_of_more_than_so_many_as_many_are_drawn(monkeypatch):
    monkeypatch.setattr(rule, "MOST", 6)
    prior = prior_of("unknown-everything")
    held = hypotheses_of(prior)
    assert len(held) == 6
    assert len({each.plant.natural_frequencies[0] for each in held}) == 6
    assert all(np.count_nonzero(each.actuator_gain < 1.0) == 1 == np.count_nonzero(each.sensor_bias) for each in held)
    for each in held:
        harmonics = [load for load in each.loads if isinstance(load, RotorHarmonics)]
        assert [load.orders for load in harmonics] == [(1,), (2,), (3,), (4,)]
        assert each.loads == foreseen_loads(prior.scenario, harmonics[0].speed)


def test_the_deflection_is_the_root_mean_square_of_those_that_episodes_start_from():
    prior = prior_of("nominal")
    (held,) = hypotheses_of(prior)
    uniforms = np.random.default_rng(1).random((40000, 7))
    speeds, none = np.full(40000, 200.0), np.zeros((40000, 0))
    cases = load_cases(prior.scenario, prior.blade.truth, np.full(40000, 180.0), uniforms, none, speeds)
    np.testing.assert_allclose(np.sqrt(np.mean(cases.deflection**2, axis=0)), held.deflection, rtol=0.03)


@pytest.mark.parametrize("name", ["delay-failure", "two-dead-actuators", "off-speed-failure"])
def test_of_scenarios_kept_for_judging_it_knows_nothing(name):
    (held,) = hypotheses_of(prior_of(name))
    assert held.delay == 0 and held.actuator_gain.all() and held.sensor_gain.all() and not held.holds_lost_readings


def test_the_controller_of_that_name_is_built_from_its_prior_and_falls_back_to_the_cautious_law():
    law = named("multiple-model").build_for(resolve_task(scenario="delay", blade={"model": "thesis"}, duration=0.1))
    assert isinstance(law, MultipleModel)
    assert len(law.prior) == 3
    assert law.fallback is not None and law.fallback.name == "cautious LQG"


def test_of_what_is_drawn_from_more_than_it_holds_quick_changes_cost_more():
    assert are_drawn(prior_of("unknown-everything"))
    assert not any(are_drawn(prior_of(name)) for name in ("nominal", "failure", "off-model", "spin-up"))
