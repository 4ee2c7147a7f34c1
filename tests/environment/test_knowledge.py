"""What controllers of each tier are told, and what they are not."""

from dataclasses import fields

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv.knowledge import TUNING, on_training_bank, on_validation_bank
from beamenv.task import resolve_task
from train.controllers.named import named
from train.learning.training import on_training_bank as task_of_training
from train.shared.held_out import held_out

SHORT = 0.02


def task(scenario, **arguments):
    return resolve_task(scenario=scenario, duration=SHORT, **arguments)


def test_a_prior_has_the_bank_that_agents_train_on_and_none_of_the_plants_that_judge():
    given = task({"plants": {"speed_ratio": [0.9, 1.1], "bank": 6}})
    assert np.array_equal(given.prior.bank.speeds, task_of_training(given).bank.speeds)
    assert not set(given.prior.bank.speeds) & set(given.bank.speeds)
    assert given.prior.scenario == on_training_bank(given.scenario) == task_of_training(given).scenario


def test_plants_that_choose_are_none_that_train_and_none_that_judge():
    given = task({"plants": {"speed_ratio": [0.9, 1.1], "bank": 6}})
    choosing = given.on_other_plants(on_validation_bank(given.scenario))
    banks = [set(each.bank.speeds) for each in (given, task_of_training(given), choosing)]
    assert len(set().union(*banks)) == 18
    assert task_of_training(choosing).prior.scenario == choosing.prior.scenario == given.prior.scenario


def test_of_a_scenario_kept_for_judging_nothing_is_told_on_other_plants_either():
    given = task("delay-off-model")
    choosing = given.on_other_plants(on_validation_bank(given.scenario))
    assert choosing.prior.scenario == given.prior.scenario
    assert choosing.prior.scenario.drive.delay == (0, 0)
    assert len(choosing.prior.bank) == 1


def test_a_prior_tells_of_the_ranges_but_not_of_a_plant_file():
    known = task("solid").prior
    assert known.scenario.plants.truth is None
    assert known.scenario.plants.modes is None
    assert np.array_equal(known.bank.plant.A, known.design.full_plant.A)


def test_of_spillover_a_design_has_five_modes_and_a_prior_the_blade_with_all():
    given = task("spillover")
    assert len(given.design.full_plant.natural_frequencies) == 5
    assert len(given.prior.bank.plant.natural_frequencies) == len(given.plant.natural_frequencies) > 11


def test_hypotheses_are_the_faults_of_the_episodes_of_tuning():
    """An environment that is seeded with the seeds of tuning meets them: none of those that controllers are compared on."""
    given = task("failure")
    drawn = given.prior.hypotheses(12)
    blades = given.prior.blades(12)
    blades.begin(given.prior.generators(12))
    for each in fields(drawn.faults):
        assert np.array_equal(getattr(drawn.faults, each.name), getattr(blades.electronics.faults, each.name)), each.name
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=12, scenario="failure", duration=SHORT)
    envs.reset(seed=list(range(TUNING, TUNING + 12)))
    assert np.array_equal(envs.unwrapped._blades.electronics.faults.actuator_gain, drawn.faults.actuator_gain)
    assert not set(range(TUNING, TUNING + 100_000)) & set(held_out(100_000))


def test_hypotheses_are_plants_of_the_bank_as_often_as_episodes_draw_them():
    given = task({"plants": {"speed_ratio": [0.9, 1.1], "bank": 6}})
    blades = given.prior.blades(40)
    blades.begin(given.prior.generators(40))
    drawn = given.prior.hypotheses(40).plant
    assert np.array_equal(drawn, blades.index)
    assert set(drawn) == set(range(6))


def test_hypotheses_of_a_blade_that_changes_are_what_it_is_in_the_middle_of_an_episode():
    given = task({"plants": {"mass_drift": 1.2, "drift_duration": [0.01, 0.02], "bank": 6}})
    blades, generators = given.prior.blades(8), given.prior.generators(8)
    blades.begin(generators)
    for _ in range(given.steps // 2):
        blades.step(np.zeros((8, 4)), generators)
    assert np.array_equal(given.prior.hypotheses(8).plant, blades.index)
    assert len(set(blades.index)) > 1


def test_each_tier_is_told_what_lower_ones_are():
    given = task({"plants": {"speed_ratio": [0.9, 1.1], "bank": 2}})
    for told in (given.told(1), given.told(2), given.told(3)):
        assert told.design.config == given.told(0).config
        assert np.array_equal(told.design.plant.A, given.told(0).plant.A)
    assert given.told(3).bank is given.bank
    with pytest.raises(ValueError, match="tier is 4, but must be a whole number from 0 to 3"):
        given.told(4)


def test_a_prior_is_refused_what_it_cannot_hold():
    known = task("nominal").prior
    with pytest.raises(ValueError, match="prior.blade is None"):
        beamenv.Prior(None, known.design_blade, known.scenario, 3)
    with pytest.raises(ValueError, match="prior.steps is 0"):
        beamenv.Prior(known.blade, known.design_blade, known.scenario, 0)


def test_hypotheses_of_what_breaks_within_the_episode_tell_when():
    given = task("mid-failure")
    drawn = given.prior.hypotheses(12)
    blades = given.prior.blades(12)
    blades.begin(given.prior.generators(12))
    assert np.array_equal(drawn.onsets.actuators, blades.electronics.state_dict()["onsets"]["actuators"])
    assert np.array_equal(drawn.faults.actuator_gain, blades.electronics.state_dict()["faults"]["actuator_gain"])
    assert task("failure").prior.hypotheses(2).onsets is None


@pytest.mark.parametrize("name", beamenv.UNSEEN_SCENARIOS)
def test_of_what_is_kept_for_judging_a_prior_tells_the_loads_alone(name):
    told, true = task(name).prior.scenario, beamenv.SCENARIOS[name]
    assert (told.shares, told.magnitude, told.rotor) == (true.shares, true.magnitude, true.rotor)
    assert not told.imperfect
    assert not told.plants.varies
    assert told.plants.truth is None


@pytest.mark.parametrize("name", ["rotor-lqg", "scheduled-lqg"])
def test_laws_that_ask_for_a_rotor_say_so_of_a_blade_at_rest(name):
    task = resolve_task("aluminium-cantilever")
    words = rf"^blade.speed is 0.0, but must be above 0 \(rad/s\) for {name}, which asks for a rotor\.$"
    with pytest.raises(ValueError, match=words):
        named(name).build_for(task)
