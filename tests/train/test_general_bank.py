"""One bank for every scenario: what it holds is what the seen ones may draw, whatever scenario it is built in."""

from dataclasses import fields

import numpy as np
import pytest

from beamenv.scenarios.named import UNSEEN
from beamenv.task import resolve_task
from train.controllers import general_bank
from train.controllers.general_bank import SEEN, general_hypotheses, general_law
from train.controllers.hypotheses import MOST, hypotheses_of
from train.controllers.named import named


def task_of(scenario):
    return resolve_task(scenario=scenario, blade={"model": "thesis"}, duration=0.1)


@pytest.fixture(name="held", scope="module")
def _held():
    return general_hypotheses(task_of("nominal").blade)


def what(hypotheses):
    return {(each.delay, tuple(each.actuator_gain), tuple(each.sensor_gain), tuple(each.sensor_bias)) for each in hypotheses}


def test_it_holds_each_delay_and_fault_of_the_scenarios_of_the_blade_s_own_plant(held):
    for name in ("nominal", "delay", "failure", "mid-failure", "rotor", "overload", "hysteresis"):
        assert what(hypotheses_of(task_of(name).prior)) <= what(held)
    assert MOST - 12 <= len(held) <= MOST
    assert {each.prior for each in held} == {1.0} and all(each.holds_lost_readings for each in held)


def test_other_plants_share_the_room_that_is_left_evenly(held):
    own = held[0].plant.natural_frequencies[0]
    others = {each.plant.natural_frequencies[0] for each in held} - {own}
    assert 12 <= len(others) <= 18
    assert min(others) < 0.9 * own and max(others) > 1.1 * own
    sizes = [len(each.loads) for each in held]
    assert sizes == sorted(sizes) and sizes[-1] > sizes[0]


def test_none_of_what_is_kept_for_judging_is_in_it(held):
    assert not set(SEEN) & set(UNSEEN) and len(SEEN) + len(UNSEEN) >= 23
    assert max(each.delay for each in held) == 3
    assert max(np.count_nonzero(each.actuator_gain == 0.0) for each in held) == 1
    delayed = [each for each in held if each.delay > 1]
    assert all(each.plant is held[0].plant and each.actuator_gain.all() and each.sensor_gain.all() for each in delayed)


def test_it_is_one_and_the_same_law_in_each_scenario_seen_or_not(monkeypatch):
    monkeypatch.setattr(general_bank, "general_hypotheses", lambda blade: hypotheses_of(task_of("delay").prior))
    general_law.cache_clear()
    laws = [named("multiple-model-general").build_for(task_of(name)) for name in ("nominal", "off-model", "delay-failure")]
    parts = [each.name for each in fields(laws[0]) if each.name != "name"]
    assert all(getattr(law, part) is getattr(laws[0], part) for law in laws[1:] for part in parts)
    assert laws[0].fallback is not None and laws[0].fallback.name == "cautious LQG"
    general_law.cache_clear()
