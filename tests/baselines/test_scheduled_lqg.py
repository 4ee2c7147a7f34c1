"""Gain scheduling: each speed's own LQG, a memory that goes on, and near the optimum between the speeds."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import PersistentLoad, lqg, reference_lqg, stationary_cost
from baselines.laws.scheduled_lqg import scheduled_lqg, scheduled_lqg_for
from beamenv.blade.build import Blade, build_plant
from beamenv.blade.presets import THESIS
from beamenv.simulation.plants.speed_family import speed_family

SPEEDS = np.array([100.0, 130.0, 160.0, 180.0, 200.0, 220.0])


@pytest.fixture(name="family", scope="module")
def _family():
    return speed_family(THESIS, SPEEDS)


def readings(steps=60, rows=()):
    return 0.05 * np.random.default_rng(4).normal(size=(steps, *rows, 4))


@pytest.mark.parametrize("load", [None, PersistentLoad()])
@pytest.mark.parametrize("index", [0, 4])
def test_a_constant_speed_of_the_family_gets_its_own_lqg(family, load, index):
    law, own = scheduled_lqg(family, load), lqg(family.plants[index], persistent_load=load)
    memory = own_memory = None
    for reading in readings():
        action, memory = law.predict(np.append(reading, SPEEDS[index]), memory)
        expected, own_memory = own.predict(reading, own_memory)
        np.testing.assert_allclose(action, expected, rtol=1e-8, atol=1e-11)
        n = len(family.plants[index].A)
        np.testing.assert_allclose(family.from_common[index] @ memory[:n], own_memory[:n], rtol=1e-7, atol=1e-9)


def test_the_estimated_tip_stays_where_it_is_when_the_speed_changes(family):
    """At 100 rad/s the first mode flaps, at 200 rad/s it lags: the modes' own coordinates would take one for the other."""
    slow, own = family.plants[0], build_plant(THESIS)
    for line_load in np.eye(2):
        estimate = -np.linalg.solve(own.A, own.disturbance_input @ line_load)
        tip = own.tip_displacement @ estimate
        carried_over = slow.tip_displacement @ family.from_common[0] @ estimate
        misread = slow.tip_displacement @ estimate
        assert np.linalg.norm(carried_over - tip) < 0.01 * np.linalg.norm(tip)
        assert np.linalg.norm(misread - tip) > 0.3 * np.linalg.norm(tip)


def test_voltages_do_not_jump_at_any_speed(family):
    law = scheduled_lqg(family)
    memory = np.random.default_rng(1).normal(size=22) * 0.01
    reading = readings(1)[0]
    for speed in (100.0, 115.0, 160.0, 199.0, 200.0, 220.0, 300.0):
        before, after = (law.predict(np.append(reading, speed + change), memory)[0] for change in (-1e-6, 1e-6))
        np.testing.assert_allclose(before, after, atol=1e-6)


@pytest.mark.parametrize("speed", [165.0, 235.0])
def test_between_its_speeds_it_is_the_optimum_but_for_a_trifle_where_a_fixed_lqg_is_not(speed):
    plant = speed_family(THESIS, [speed]).plants[0]
    optimum = stationary_cost(plant, lqg(plant))
    assert optimum <= stationary_cost(plant, scheduled_lqg_for(THESIS).at(speed)) < 1.0001 * optimum
    assert stationary_cost(plant, lqg(build_plant(THESIS))) > 1.05 * optimum


def test_at_six_tenths_of_its_design_speed_a_fixed_lqg_is_unstable_and_a_scheduled_one_is_not(family):
    plant = speed_family(THESIS, [120.0]).plants[0]
    assert stationary_cost(plant, lqg(build_plant(THESIS))) == np.inf
    assert stationary_cost(plant, scheduled_lqg(family).at(120.0)) < 1.005 * stationary_cost(plant, lqg(plant))


def test_a_batch_may_turn_at_several_speeds(family):
    law = scheduled_lqg(family)
    speeds = np.array([90.0, 150.0, 200.0, 500.0])
    memory = single = None
    for rows in readings(20, (4,)):
        action, memory = law.predict(np.column_stack([rows, speeds]), memory, episode_start=np.zeros(4, dtype=bool))
        one, single = law.predict(np.append(rows[1], speeds[1]), single)
        np.testing.assert_allclose(one, action[1], rtol=1e-12, atol=1e-15)
    linear = law.at(150.0)
    np.testing.assert_allclose(linear.predict(rows[1], single)[0], law.predict(np.append(rows[1], 150.0), single)[0], rtol=1e-9)
    begun, _ = law.predict(np.column_stack([rows, speeds]), memory, episode_start=np.ones(4, dtype=bool))
    np.testing.assert_array_equal(begun, law.predict(np.column_stack([rows, speeds]))[0])
    volts, _ = law.in_physical_units().predict(np.column_stack([rows * linear.instruments.measurement_scale, speeds]))
    np.testing.assert_allclose(volts, begun * linear.instruments.voltage_scale, rtol=1e-9, atol=1e-9)


def test_what_cannot_be_scheduled_is_refused_by_name(family):
    law = scheduled_lqg(family)
    with pytest.raises(ValueError, match=r"observation has shape \(4,\).*observation and speed vectors of length 5"):
        law.predict(np.zeros(4))
    with pytest.raises(ValueError, match="must be finite observation and speed vectors"):
        law.predict(np.append(np.zeros(4), np.nan))
    with pytest.raises(ValueError, match=r"speeds = \[200, 100\] must be"):
        speed_family(THESIS, [200, 100])
    with pytest.raises(ValueError, match="4 modes at 0 rad/s are not those at 200 rad/s"):
        speed_family(replace(THESIS, modes=4), [0.0])
    with pytest.raises(ValueError, match="^speeds is None, but must be given for a blade at rest"):
        scheduled_lqg_for(replace(THESIS, speed=0.0))
    other = replace(family.plants[1], control_interval=1e-3)
    with pytest.raises(ValueError, match="differ in control_interval"):
        scheduled_lqg(replace(family, plants=(family.plants[0], other, *family.plants[2:])))


@pytest.mark.parametrize(("speed", "more"), [(120.0, 0.0059), (185.0, 0.0025), (290.0, 0.0111)])
def test_on_all_that_is_known_it_is_near_the_optimum_of_every_speed_behind_the_electronics(speed, more):
    """As "scheduled-lqg" is: seven speeds from half to half as much again as the blade's own."""
    law = scheduled_lqg_for(THESIS, THESIS.speed * np.linspace(0.5, 1.5, 7), full=True, rate_weight=1.0)
    truth = Blade(replace(THESIS, speed=speed, sensor_full_scale=float(build_plant(THESIS).sensor_full_scale[0]))).truth
    optimum = stationary_cost(truth, lqg(truth))
    assert stationary_cost(truth, law.at(speed)) / optimum - 1.0 == pytest.approx(more, abs=3e-4)
    assert stationary_cost(truth, scheduled_lqg_for(THESIS).at(speed)) == np.inf


def test_at_seven_tenths_of_its_design_speed_the_reference_is_unstable():
    slow = Blade(replace(THESIS, speed=140.0, sensor_full_scale=float(build_plant(THESIS).sensor_full_scale[0]))).truth
    assert stationary_cost(slow, reference_lqg(Blade(THESIS).truth)) == np.inf
