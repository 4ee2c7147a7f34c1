"""Positive position feedback on one mode: Fanson and Caughey's stability limit and damping; and its place among the laws."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import closed_loop_poles, no_control, stationary_cost, velocity_feedback
from baselines.laws.positive_position_feedback import positive_position_feedback

OMEGA, DAMPING = 200.0, 0.01
ALMOST_NO_LEAK = 1e-5


@pytest.fixture(name="mode")
def _mode(scalar_plant):
    """One mode with one pair of patches, sampled so fast that it might be continuous."""
    return replace(
        scalar_plant(),
        A=np.array([[0.0, OMEGA], [-OMEGA, -2.0 * DAMPING * OMEGA]]),
        B=np.array([[0.0], [2e-4]]),
        C=np.array([[0.0, 3e-4]]),
        disturbance_input=np.array([[0.0, 0.0], [0.5, 0.2]]),
        tip_displacement=np.zeros((2, 2)),
        strain=np.zeros((1, 2)),
        natural_frequencies=np.array([OMEGA]),
        state_weight=0.5 * np.eye(2),
        control_interval=1e-5,
    )


@pytest.mark.parametrize("filter_damping", [0.1, 0.5])
def test_one_mode_is_stable_exactly_up_to_unit_gain(mode, filter_damping):
    for gain in (0.001, 0.5, 0.999):
        law = positive_position_feedback(mode, gain, modes=1, filter_damping=filter_damping, leak=ALMOST_NO_LEAK, verify=False)
        assert closed_loop_poles(mode, law).real.max() < 0
    for gain in (-0.5, 1.001, 2.0):
        law = positive_position_feedback(mode, gain, modes=1, filter_damping=filter_damping, leak=ALMOST_NO_LEAK, verify=False)
        assert closed_loop_poles(mode, law).real.max() > 0


@pytest.mark.parametrize("gain", [0.05, 0.3, 0.8])
def test_poles_are_the_roots_of_fanson_and_caugheys_quartic(mode, gain):
    law = positive_position_feedback(mode, gain, modes=1, filter_damping=0.4, leak=ALMOST_NO_LEAK, verify=False)
    blade, filter_ = [1.0, 2 * DAMPING * OMEGA, OMEGA**2], [1.0, 0.8 * OMEGA, OMEGA**2]
    quartic = np.polysub(np.polymul(blade, filter_), [gain * OMEGA**4])
    poles = closed_loop_poles(mode, law)
    found = np.sort_complex(poles[np.abs(poles) > 1e-2 * OMEGA])  # without the integrator's own
    np.testing.assert_allclose(found, np.sort_complex(np.roots(quartic)), atol=4e-3 * OMEGA)


def test_a_little_gain_adds_a_quarter_of_itself_over_the_filter_damping(mode):
    """g/4(ζ_f − ζ), from the quartic's derivative at the blade's own pole."""
    gain, filter_damping = 1e-3, 0.5
    law = positive_position_feedback(mode, gain, modes=1, filter_damping=filter_damping, leak=ALMOST_NO_LEAK, verify=False)
    slowest = closed_loop_poles(mode, law)
    blade = slowest[(np.abs(slowest.imag) > 0.5 * OMEGA)][0]
    without = closed_loop_poles(mode, no_control(mode))[0]
    added = (without.real - blade.real) / OMEGA
    assert added == pytest.approx(gain / (4 * (filter_damping - DAMPING)), rel=0.002)


def test_default_gains_damp_a_blade_of_several_modes(small_plant):
    plant = small_plant()
    law = positive_position_feedback(plant)
    assert law.transition.shape == (2 * (1 + 2 * 3),) * 2
    assert stationary_cost(plant, law) < 0.25 * stationary_cost(plant, no_control(plant))


def test_no_other_gains_cost_less(small_plant):
    plant = small_plant()
    optimum = stationary_cost(plant, positive_position_feedback(plant, modes=1))
    laws = (positive_position_feedback(plant, gain, modes=1, verify=False) for gain in np.linspace(0.0, 1.2, 61))
    costs = [stationary_cost(plant, law) for law in laws]
    assert optimum <= min(costs) * (1 + 1e-5)


def test_ganged_drive_hears_the_mean_of_the_sensors(small_plant):
    separate = small_plant()
    plant = small_plant(
        B=separate.B.sum(axis=1, keepdims=True),
        D=np.zeros((2, 1)),
        input_weight=np.array([[separate.input_weight.sum()]]),
        voltage_limits=separate.voltage_limits[:, :1],
    )
    law = positive_position_feedback(plant)
    np.testing.assert_array_equal(law.measurement_gain[:, 0], law.measurement_gain[:, 1])
    assert stationary_cost(plant, law) < stationary_cost(plant, no_control(plant))


def test_what_is_not_allowed_is_refused_by_name(small_plant):
    plant = small_plant()
    with pytest.raises(ValueError, match="2 actuators and 1 sensors, which positive position feedback cannot pair"):
        positive_position_feedback(small_plant(C=plant.C[:1], sensor_full_scale=plant.sensor_full_scale[:1]))
    with pytest.raises(ValueError, match="modes is 4, but must be a whole number from 1 to 3"):
        positive_position_feedback(plant, modes=4)
    with pytest.raises(ValueError, match="filter_damping is 0.0, but must be a positive number"):
        positive_position_feedback(plant, filter_damping=0.0)
    with pytest.raises(ValueError, match="gain = .* or 3 of them"):
        positive_position_feedback(plant, gain=[0.1, 0.2])


@pytest.mark.parametrize("gain", ["a", [1.0] * 7, True, np.nan, [0.1, 0.1, 1j]])
def test_gains_that_are_no_numbers_are_refused(small_plant, gain):
    for law in (velocity_feedback, positive_position_feedback):
        with pytest.raises(ValueError, match="gain = .* must be a finite number, or . of them, one for each"):
            law(small_plant(), gain=gain)
