"""Delay, lost readings, failures, clipping: what lies between a controller and its blade."""

import numpy as np
import pytest
from scipy.stats import binomtest, chisquare

from baselines import lqg
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.scenarios.tables import Failures
from beamenv.simulation.signals.faults import DRAWS, Faults, SignalMemory, acquire, draw_faults, drive

CASES = dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0)
QUIET = {**CASES, "white_load": False, "sensor_noise": False}


def drawn(count=30_000, failures=None, delay=(0, 0), seed=0):
    uniforms = np.random.default_rng(seed).random((count, DRAWS))
    return draw_faults(failures or SCENARIOS["failure"].failures, delay, uniforms, 4, 4)


def test_delays_are_whole_numbers_of_intervals_all_equally_likely():
    delays = drawn(delay=(1, 3)).delay
    counts = np.bincount(delays, minlength=5)
    assert counts[0] == counts[4] == 0
    assert chisquare(counts[1:4]).pvalue > 0.001


@pytest.mark.parametrize("delay", [0, 1, 2, 3])
def test_a_voltage_acts_so_many_intervals_late(delay):
    """The state equals that of a blade without delay that is asked for the same voltages later; until then nothing acts."""
    late, prompt = (RotatingBeamEnv(scenario=QUIET | {"drive": {"delay": each}}) for each in (delay, 0))
    late.reset(seed=0)
    prompt.reset(seed=0)
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, size=(30, 4))
    for k, action in enumerate(actions):
        *_, info = late.step(action)
        prompt.step(actions[k - delay] if k >= delay else np.zeros(4))
        np.testing.assert_allclose(late.state, prompt.state, atol=1e-14)
        np.testing.assert_allclose(info["volts"], 1500.0 * action)  # what was asked for


def test_blades_of_one_batch_have_delays_of_their_own():
    faults = Faults(np.array([0, 2, 1]), np.ones((3, 1)), np.ones((3, 1)), np.zeros((3, 1)))
    memory = SignalMemory(np.zeros((3, 3, 1)), np.zeros((3, 1, 0)), np.zeros((3, 1)))
    acted = []
    for k in range(1, 6):
        acting, memory = drive(faults, None, memory, np.full((3, 1), float(k)))
        acted.append(acting[:, 0].tolist())
    assert acted == [[1, 0, 0], [2, 0, 1], [3, 1, 2], [4, 2, 3], [5, 3, 4]]


def test_a_new_episode_forgets_the_voltages_under_way():
    env = RotatingBeamEnv(scenario=QUIET | {"drive": {"delay": 3}})
    env.reset(seed=0)
    for _ in range(3):
        env.step(np.ones(4))
    env.reset(seed=1)
    env.step(np.zeros(4))
    assert not env.state.any()


def test_one_reading_in_twenty_is_lost_and_the_last_one_shown_again():
    """Noise makes every true reading differ from the one before."""
    envs = RotatingBeamVectorEnv(100, scenario="delay", duration=0.5)
    before, _ = envs.reset(seed=3)
    held = []
    for _ in range(200):
        after, *_ = envs.step(np.zeros((100, 4)))
        held.append(after == before)
        before = after
    held = np.array(held)
    assert binomtest(int(held.sum()), held.size, 0.05).pvalue > 0.001
    pairs = (held[:, :, 0] & held[:, :, 1]).sum()  # sensor by sensor, independently
    assert binomtest(int(pairs), held[:, :, 0].size, 0.05**2).pvalue > 0.001
    again = (held[1:] & held[:-1]).sum()
    assert binomtest(int(again), held[1:].size, 0.05**2).pvalue > 0.001


def test_a_lost_reading_is_the_last_one_shown_not_the_last_one_measured():
    faults = Faults(np.zeros(1, dtype=int), np.ones((1, 1)), np.ones((1, 1)), np.zeros((1, 1)))
    memory = SignalMemory(np.zeros((1, 1, 1)), np.zeros((1, 1, 0)), np.zeros((1, 1)))
    shown = []
    for value, lost in ((0.1, False), (0.2, True), (0.3, True), (0.4, False)):
        reading, memory = acquire(faults, memory, np.array([[value]]), np.zeros((1, 1)), np.array([[lost]]))
        shown.append(float(reading[0, 0]))
    assert shown == [0.1, 0.1, 0.1, 0.4]


def test_every_actuator_and_every_sensor_fails_equally_often():
    faults = drawn()
    assert np.all((faults.actuator_gain == 0.0).sum(axis=1) == 1)
    assert chisquare((faults.actuator_gain == 0.0).sum(axis=0)).pvalue > 0.001
    faulty = (faults.sensor_gain == 0.0) | (faults.sensor_bias != 0.0)
    assert np.all(faulty.sum(axis=1) == 1)
    assert chisquare(faulty.sum(axis=0)).pvalue > 0.001
    table = np.zeros((4, 4))
    np.add.at(table, (faults.actuator_gain.argmin(axis=1), faulty.argmax(axis=1)), 1)
    assert chisquare(table.ravel()).pvalue > 0.001  # which actuator says nothing of which sensor


def test_half_of_the_faulty_sensors_are_biased_by_5_to_20_percent_of_full_scale_either_way():
    faults = drawn()
    biased = (faults.sensor_bias != 0.0).any(axis=1)
    assert binomtest(int(biased.sum()), len(biased), 0.5).pvalue > 0.001
    assert not (biased & (faults.sensor_gain == 0.0).any(axis=1)).any()
    bias = faults.sensor_bias[faults.sensor_bias != 0.0]
    assert np.all((np.abs(bias) >= 0.05) & (np.abs(bias) <= 0.2))
    assert binomtest(int((bias > 0.0).sum()), len(bias), 0.5).pvalue > 0.001
    assert np.abs(bias).mean() == pytest.approx(0.125, abs=4.0 * 0.15 / np.sqrt(12.0 * len(bias)))


@pytest.mark.parametrize("count", [0, 1, 3, 4, 9])
def test_so_many_actuators_are_dead(count):
    assert np.all((drawn(100, Failures(dead_actuators=count)).actuator_gain == 0.0).sum(axis=1) == min(count, 4))


def test_a_dead_actuator_does_nothing_and_stores_nothing():
    env = RotatingBeamEnv(scenario=QUIET | {"failures": {"dead_actuators": 4}})
    env.reset(seed=0)
    *_, info = env.step(np.ones(4))
    assert not env.state.any()
    assert info["effort"] == info["cost_increment"] == 0.0
    np.testing.assert_allclose(info["volts"], 1500.0)


def test_one_dead_actuator_leaves_the_other_three():
    """The blade moves as a sound one that is asked for nothing there; which one it is, the effort of single voltages tells."""
    broken, sound = RotatingBeamEnv(scenario=QUIET | {"failures": {"dead_actuators": 1}}), RotatingBeamEnv(scenario=QUIET)
    dead = []
    for k in range(4):
        broken.reset(seed=11)
        dead.append(broken.step(np.eye(4)[k])[4]["effort"] == 0.0)
    assert sum(dead) == 1
    broken.reset(seed=11)
    sound.reset(seed=11)
    for k in range(20):
        action = np.random.default_rng(k).uniform(-1.0, 1.0, size=4)
        ours, theirs = broken.step(action), sound.step(np.where(dead, 0.0, action))
        np.testing.assert_allclose(broken.state, sound.state, atol=1e-14)
        assert ours[1] == pytest.approx(theirs[1], rel=1e-9)


def test_a_dead_sensor_gives_noise_alone_and_a_biased_one_its_bias_besides():
    scenario = {"step": 1.0, "pulse": 0.0, "deflection": 0.0, "harmonic": 0.0, "failures": {"faulty_sensors": 1}}
    envs, sound = RotatingBeamVectorEnv(64, scenario=scenario), RotatingBeamVectorEnv(64, scenario=scenario | {"failures": {}})
    readings, truth = [], []
    for each, found in ((envs, readings), (sound, truth)):
        each.reset(seed=2, options={"load": {"case": "step", "magnitude": 30.0, "direction_deg": 60.0, "onset": 0.0}})
        found.extend(each.step(np.zeros((64, 4)))[0] for _ in range(999))
    faults, readings = envs._blades.electronics.faults, np.array(readings)
    dead, biased = np.argwhere(faults.sensor_gain == 0.0)[:8], np.argwhere(faults.sensor_bias != 0.0)[:8]
    assert len(dead) == len(biased) == 8
    for row, sensor in dead:
        assert readings[:, row, sensor].std() == pytest.approx(0.02, rel=0.1)  # 2 % of full scale
        assert abs(readings[:, row, sensor].mean()) < 4.0 * 0.02 / np.sqrt(999)
    for row, sensor in biased:
        others = np.array(truth)[:, :, sensor].std(axis=0).mean()
        assert readings[:, row, sensor].mean() == pytest.approx(faults.sensor_bias[row, sensor], abs=0.01)
        assert readings[:, row, sensor].std() == pytest.approx(others, rel=0.5)


def test_an_overload_saturates_lqg_and_clips_the_sensors():
    """Steps of 500 N/m: LQG has its voltages at a limit for most of the time, and a good part of the readings is at full scale."""
    envs = RotatingBeamVectorEnv(32, scenario="overload", duration=0.25)
    controller, state = lqg(envs.design_plant), None
    observation, _ = envs.reset(seed=0)
    saturated, clipped = [], []
    for k in range(499):
        action, state = controller.predict(observation, state, np.full(32, k == 0))
        observation, _, failed, _, info = envs.step(action)
        saturated.append(np.abs(info["volts"]) == 1500.0)
        clipped.append(np.abs(observation) == 1.0)
        assert not failed.any()
    assert np.mean(saturated) > 0.5
    assert np.mean(clipped) > 0.2
    assert np.abs(observation).max() <= 1.0
