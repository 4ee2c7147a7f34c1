"""The proof: an LQG of a plant identified from the blade with all its modes and electronics, beside the LQG of that blade."""

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import Measurement, evaluate, identify, lqg
from baselines.design.loop import closed_loop, sampled, spectral_radius
from beamenv.blade.presets import SOUND_EDGES

SEEDS = range(3_000_000, 3_000_032)
RATIO = 5 / 3  # thickness of the actuators' field, 0.5 mm, over the sensors', 0.3 mm
INTERVAL = 5e-4


def groups():
    """The patches of ``sound-blade``, the second of each kind at 45°: it twists the blade and feels it twist."""
    first, second, *others = SOUND_EDGES
    return [{"positions": [first, *others]}, {"positions": [second], "angle_deg": 45.0}]


TWISTED = {"patches": {"actuators": groups(), "sensors": [{**group, "wall": "bottom"} for group in groups()]}}


def measured(seconds, seed, blade=None, deviation=450.0):
    """``sound-blade`` at 2 kHz in white loads, voltages random and held, currents with the noise of the environment."""
    lab = {"preset": "sound-blade", "blade": blade, "scenario": "white", "duration": seconds}
    env = gym.make(beamenv.ENV_ID, **lab, physical_units=True, dtype="float64")
    rng, rows = np.random.default_rng(seed), []
    reading, _ = env.reset(seed=seed)
    volts = np.clip(rng.normal(0.0, deviation, (round(seconds / INTERVAL), 4)), -1500.0, 1500.0)
    for each in volts:
        rows.append(reading)
        reading, _, failed, _, _ = env.step(each)
        assert not failed
    return Measurement(volts, np.array(rows), INTERVAL, reading_units=("A",) * 4)


@pytest.mark.slow
def test_lqg_on_a_plant_of_twenty_seconds_is_within_three_percent_of_lqg_on_the_truth():
    found = identify(measured(20.0, seed=1), collocated=RATIO)
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=32, preset="sound-blade", dtype="float64")
    truth = envs.unwrapped.plant
    nearest = np.abs(found.modes.frequency[:, None] - truth.natural_frequencies).argmin(axis=1)
    assert len(set(nearest)) == len(found.modes) >= 9  # the torsion of 920 rad/s is hardly seen
    assert np.all(np.abs(found.modes.frequency / truth.natural_frequencies[nearest] - 1.0) < 3e-3)
    assert found.sensor_noise == pytest.approx(0.02 * truth.sensor_full_scale, rel=0.05)
    assert_nearly_as_good(found, truth, envs)


@pytest.mark.slow
def test_all_eleven_modes_are_identified_where_a_sheet_at_an_angle_twists_the_blade():
    found = identify(measured(20.0, seed=1, blade=TWISTED, deviation=300.0), collocated=RATIO)  # at 450 V the twist is cut off
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=32, preset="sound-blade", blade=TWISTED, dtype="float64")
    truth = envs.unwrapped.plant
    nearest = np.abs(found.modes.frequency - truth.natural_frequencies[:, None]).argmin(axis=1)
    assert len(set(nearest)) == len(truth.natural_frequencies) == 11
    error = np.abs(found.modes.frequency[nearest] - truth.natural_frequencies)
    assert np.all(error < 2e-3 * truth.natural_frequencies)
    assert np.all(error < 4.0 * found.modes.frequency_spread[nearest])
    assert_nearly_as_good(found, truth, envs)


def assert_nearly_as_good(found, truth, envs):
    """The LQG of the plant that was found costs at most 3 % more than that of the true one."""
    best = evaluate(lqg(truth), envs, SEEDS)
    for known in ({}, {"input_weight": truth.input_weight}):  # the price of a volt by rule, then the environment's own
        plant = found.plant(actuator_limits=1500.0, full_scale=truth.sensor_full_scale, **known)
        own = evaluate(lqg(plant), envs, SEEDS, reference=best.reference)
        assert own.relative_cost.value < 1.03 * best.relative_cost.value


@pytest.mark.parametrize(("volts", "held", "told"), [(3.0, 1, True), (20.0, 16, False)], ids=["drowned", "heard"])
def test_a_lab_beam_whose_first_mode_the_voltages_hardly_move_has_an_lqg_that_is_told_to_be_unsafe(volts, held, told):
    """Where loads drown them, nobody knows how far a voltage moves it, and an LQG that guesses drives it."""
    lab = {"preset": "aluminium-cantilever", "scenario": "white", "duration": 8.0}
    env = gym.make(beamenv.ENV_ID, **lab, physical_units=True, dtype="float64")
    rng, rows = np.random.default_rng(0), []
    reading, _ = env.reset(seed=0)
    voltages = np.repeat(rng.normal(0.0, volts, (16_000 // held, 1)), held, axis=0)
    for each in voltages:
        rows.append(reading)
        reading, *_ = env.step(each)
    found = identify(Measurement(voltages, np.array(rows), INTERVAL, reading_units=("A",)), collocated=1.0)
    known = {"actuator_limits": 150.0}
    law, truth = lqg(found.plant(**known)), env.unwrapped.plant
    assert (found.unstable_on(law, **known) > 0) == told
    assert (spectral_radius(closed_loop(sampled(truth, law), law)[0]) > 1.0) == told
