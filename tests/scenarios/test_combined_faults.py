"""Scenarios with several faults at once: each fault is the one of the benchmark's scenario, or one beyond it."""

import numpy as np
import pytest
from scipy.stats import kstest

import beamenv
from beamenv import RotatingBeamEnv
from beamenv.scenarios.scenario import SCENARIOS, Scenario, scenario
from beamenv.scenarios.tables import Drive, Failures, PlantVariation, Rotor
from beamenv.simulation.signals.faults import DRAWS, draw_faults

PAIRS = [
    ("off-speed-failure", ("off-speed", "plants"), ("failure", "failures")),
    ("delay-off-model", ("delay", "drive", "acquisition"), ("off-model", "plants")),
    ("delay-failure", ("delay", "drive", "acquisition"), ("failure", "failures")),
    ("hysteresis-rotor", ("hysteresis", "drive"), ("rotor", "rotor", "step", "pulse", "deflection", "harmonic")),
]


@pytest.mark.parametrize(("name", "one", "other"), PAIRS)
def test_a_pair_has_both_faults_as_they_are_alone_and_no_third(name, one, other):
    pair, expected = SCENARIOS[name].to_dict(), Scenario().to_dict()
    for origin, *tables in (one, other):
        expected.update({table: SCENARIOS[origin].to_dict()[table] for table in tables})
    assert pair == expected


def test_three_go_one_step_beyond_what_the_benchmark_has():
    assert SCENARIOS["long-delay"].drive.delay == (4, 4)
    assert SCENARIOS["delay"].drive.delay[1] == 3
    assert scenario({"preset": "long-delay", "drive": {"delay": [1, 3]}}) == SCENARIOS["delay"]
    assert SCENARIOS["two-dead-actuators"] == Scenario(failures=Failures(dead_actuators=2))
    beyond = SCENARIOS["biased-sensor"].failures
    assert beyond == Failures(faulty_sensors=1, biased_share=1.0, bias=(0.3, 0.3))
    assert SCENARIOS["failure"].failures.bias[1] == 0.2


def test_unknown_everything_has_every_kind_of_fault_each_milder_than_alone():
    every = SCENARIOS["unknown-everything"]
    for table, plain in (("plants", PlantVariation()), ("drive", Drive()), ("rotor", Rotor()), ("failures", Failures())):
        assert getattr(every, table) != plain
    worst = {"speed_ratio": "off-speed"} | dict.fromkeys(("ply_angle_ratio", "modulus_ratio", "mass_ratio"), "off-model")
    for ratio, alone in worst.items():
        ours, theirs = getattr(every.plants, ratio), getattr(SCENARIOS[alone].plants, ratio)
        assert theirs[0] < ours[0] < 1.0 < ours[1] < theirs[1]
    assert 0.0 < every.drive.hysteresis < SCENARIOS["hysteresis"].drive.hysteresis
    assert 0 < every.drive.delay[1] < SCENARIOS["delay"].drive.delay[1]
    assert 0.0 < every.acquisition.dropout < SCENARIOS["delay"].acquisition.dropout
    assert every.failures.bias[1] < SCENARIOS["failure"].failures.bias[1]
    assert every.failures.remaining[0] > 0.0
    assert all(ours < theirs for ours, theirs in zip(every.rotor.harmonics, SCENARIOS["rotor"].rotor.harmonics, strict=True))
    assert 0.0 < every.rotor.turbulence < SCENARIOS["rotor"].rotor.turbulence


def test_what_is_left_of_a_weak_actuator_is_uniform_whichever_it_is():
    failures = Failures(dead_actuators=1, remaining=(0.4, 0.8))
    gain = draw_faults(failures, (0, 0), np.random.default_rng(0).random((20_000, DRAWS)), 4, 4).actuator_gain
    np.testing.assert_array_equal((gain < 1.0).sum(axis=1), 1)
    for actuator in range(4):
        weak = gain[:, actuator]
        assert kstest(weak[weak < 1.0], "uniform", (0.4, 0.4)).pvalue > 0.001


def test_a_weak_actuator_acts_as_a_sound_one_under_its_share_of_the_voltage():
    quiet = {**dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0), "white_load": False, "sensor_noise": False}
    weak = RotatingBeamEnv(scenario=quiet | {"failures": {"dead_actuators": 4, "remaining": 0.5}})
    sound = RotatingBeamEnv(scenario=quiet)
    weak.reset(seed=0)
    sound.reset(seed=0)
    for action in np.random.default_rng(1).uniform(-1.0, 1.0, (10, 4)):
        ours, theirs = weak.step(action), sound.step(0.5 * action)
        np.testing.assert_allclose(weak.state, sound.state, rtol=0.0, atol=1e-14)
        assert ours[1] == pytest.approx(theirs[1], rel=1e-12)


@pytest.mark.parametrize("name", beamenv.OPEN_SCENARIOS)
def test_no_controller_is_told_of_an_open_scenario(name):
    """The design is that of the nominal blade, and a tachometer is all that is measured besides."""
    few = {"preset": name, "plants": {"bank": 2}}
    told, nominal = (RotatingBeamEnv(scenario=chosen, duration=0.01).design for chosen in (few, "nominal"))
    np.testing.assert_array_equal(told.full_plant.A, nominal.full_plant.A)
