"""What the explorer says of the loop: by ``baselines``, and as the package control has it."""

import control
import numpy as np
import pytest

from baselines import closed_loop_poles, lqg, no_control, stability_margins
from beamenv.blade.build import build_plant
from beamenv.blade.presets import THESIS
from beamenv.plant.plant import drive_limit, sample
from beamenv.scenarios.load_cases import static_deflection

pytest.importorskip("dash", reason="dash is not installed")

from train.explore import Settings, loop  # noqa: E402 - they need the package asked for above
from train.explore.app import analyse  # noqa: E402
from train.explore.controls import THESIS_PAGE  # noqa: E402


@pytest.fixture(scope="module")
def plant():
    return build_plant(THESIS)


@pytest.fixture(scope="module")
def thesis():
    return loop(Settings(actuator=2, sensor=3))


def test_poles_and_margins_are_those_of_the_baselines(plant, thesis):
    law = lqg(plant)
    np.testing.assert_allclose(thesis.poles["LQG"], closed_loop_poles(plant, law), rtol=1e-9)
    np.testing.assert_allclose(thesis.poles["no control"], closed_loop_poles(plant, no_control(plant)), rtol=1e-9)
    for where, at in (("voltages", "input"), ("readings", "output")):
        assert thesis.margins[where].disk_margin == pytest.approx(stability_margins(plant, law, at).disk_margin, rel=1e-9)


def test_the_bode_diagram_is_control_s(plant, thesis):
    """From voltage 2 to reading 3, alone and within the loop."""
    law = lqg(plant)
    voltages = sample(plant).to_control()[:, :4]
    looped = control.feedback(voltages, law.to_control()[:, :4], sign=1)
    size = drive_limit(plant)[1] / plant.sensor_full_scale[2]
    chosen = np.linspace(0, len(thesis.frequencies) - 2, 40).astype(int)
    for name, system in (("no control", voltages), ("LQG", looped)):
        expected = size * np.array([system(np.exp(1j * w * plant.control_interval))[2, 1] for w in thesis.frequencies[chosen]])
        np.testing.assert_allclose(thesis.bode[name][chosen], expected, rtol=1e-6, atol=1e-9)


def test_singular_values_bound_every_pair(thesis):
    largest = thesis.plant_gains[:, 0]
    assert np.all(np.diff(thesis.plant_gains, axis=1) <= 0.0)
    for k in range(1, 5):
        pair = loop(Settings(actuator=k, sensor=k)).bode["no control"]
        assert np.all(np.abs(pair) <= largest * (1.0 + 1e-9))


def test_a_slow_load_moves_the_tip_as_far_as_a_lasting_one(plant, thesis):
    """At a tenth of the first natural frequency a lightly damped mode answers 1/(1 − 0.1²) times its static deflection."""
    static = np.linalg.norm(np.stack([plant.tip_displacement @ static_deflection(plant, load) for load in np.eye(2)]), ord=2)
    assert static <= thesis.load_gains["no control"][0] <= 1.012 * static


def test_lqg_lowers_the_highest_resonance(thesis):
    highest = {name: gains.max() for name, gains in thesis.load_gains.items()}
    assert highest["LQG"] < 0.5 * highest["no control"]


@pytest.mark.parametrize(
    "weights", [{"strain_energy_weight": 3.0}, {"kinetic_energy_weight": 0.1}, {"actuator_energy_weight": 20.0}]
)
def test_any_weights_but_the_blade_s_own_cost_more_of_its_own(weights):
    found = loop(Settings(**weights))
    assert found.least_cost < found.cost < 1.0
    assert loop(Settings()).cost == found.least_cost


def test_only_the_ratio_of_the_weights_counts(thesis):
    same = loop(Settings(strain_energy_weight=7.0, kinetic_energy_weight=7.0, actuator_energy_weight=7.0))
    assert same.cost == pytest.approx(thesis.cost, rel=1e-6)
    assert same.margins["voltages"].disk_margin == pytest.approx(thesis.margins["voltages"].disk_margin, rel=1e-5)


def test_noisier_sensors_make_a_slower_filter_and_more_margin():
    quiet, noisy = (loop(Settings(sensor_noise_fraction=noise)) for noise in (0.005, 0.2))
    assert noisy.cost > quiet.cost
    assert noisy.margins["readings"].disk_margin > quiet.margins["readings"].disk_margin


def test_what_has_no_loop_is_told_in_one_sentence():
    said = analyse(**THESIS_PAGE.start | {"sensors": [0.0, 20.0, 500.0, 900.0]})
    assert "overlap" in said["lost"] and said["lost"].endswith(".")


def test_sensitivity_is_control_s_and_its_peak_that_of_the_margins(plant, thesis):
    """S = (I + L)⁻¹ with the loops as transfer functions; the curve's grid may miss the top of a peak by a little."""
    blade, law = sample(plant).to_control()[:, :4], lqg(plant).to_control()[:, :4]
    drive, full = np.diag(drive_limit(plant)), np.diag(plant.sensor_full_scale)
    for k in np.linspace(0, len(thesis.frequencies) - 2, 30).astype(int):
        z = np.exp(1j * thesis.frequencies[k] * plant.control_interval)
        P, K = np.linalg.solve(full, blade(z)) @ drive, np.linalg.solve(drive, law(z)) @ full
        for where, loop_gain in (("voltages", -K @ P), ("readings", -P @ K)):
            S = np.linalg.inv(np.eye(4) + loop_gain)
            assert thesis.sensitivity[where][k] == pytest.approx(np.linalg.norm(S, 2), rel=1e-6)
    for where, margins in thesis.margins.items():
        assert 0.99 * margins.peak_sensitivity <= thesis.sensitivity[where].max() <= margins.peak_sensitivity * (1.0 + 1e-9)
