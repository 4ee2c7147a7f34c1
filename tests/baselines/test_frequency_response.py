"""Frequency responses against first-order systems written down by hand, and against the mean cost they integrate to."""

import numpy as np
import pytest

from baselines import lqg, no_control, stationary_cost
from baselines.analysis.frequency_response import cost_response, frequency_response, h_infinity_norm, square_root
from baselines.laws.velocity_feedback import velocity_feedback
from beamenv.plant.plant import sample


def test_a_first_order_lag_has_its_response_by_hand():
    one, angles = np.ones((1, 1)), np.array([0.0, 0.3, np.pi])
    response = frequency_response(0.8 * one, 0.5 * one, 2.0 * one, 3.0 * one, angles)[:, 0, 0]
    np.testing.assert_allclose(response, 3.0 + 1.0 / (np.exp(1j * angles) - 0.8), rtol=1e-13)


def test_the_worst_load_on_a_decaying_state_is_a_constant_one(scalar_plant):
    a, e, q, w = -40.0, 0.5, 0.5, 4.5e-3
    plant = scalar_plant(a=a, e=e, q=q, w=w)
    by_hand = np.sqrt(q * w) * e / abs(a)  # √q x of the static deflection, for a load of unit intensity
    assert h_infinity_norm(plant, no_control(plant)) == pytest.approx(by_hand, rel=1e-9)


def test_a_light_mode_is_found_at_its_peak(small_plant):
    omega, damping = 180.0, 2e-4
    A = np.array([[0.0, omega], [-omega, -2.0 * damping * omega]])
    plant = small_plant(
        A=A,
        B=np.zeros((2, 2)),
        C=np.zeros((2, 2)),
        disturbance_input=np.array([[0.0, 0.0], [0.4, 0.0]]),
        state_weight=0.5 * np.eye(2),
        process_noise=np.diag([9.0, 0.0]) * 5e-4,
    )
    by_hand = 0.4 * np.sqrt(9.0 * 5e-4) / (2.0 * damping * omega)  # ½(|x₁|² + |x₂|²) = |x₂|² at resonance
    assert h_infinity_norm(plant, no_control(plant)) == pytest.approx(by_hand, rel=1e-3)


def test_the_mean_cost_is_the_integral_of_the_squared_response(small_plant):
    plant = small_plant()
    law = lqg(plant)
    angles = np.pi * (np.arange(20000) + 0.5) / 20000
    squared = (np.abs(cost_response(plant, law, angles / plant.control_interval)) ** 2).sum(axis=(1, 2))
    assert squared.mean() / plant.control_interval == pytest.approx(stationary_cost(plant, law), rel=1e-9)


def test_an_unstable_loop_has_no_finite_norm(small_plant):
    plant = small_plant()
    assert h_infinity_norm(plant, velocity_feedback(plant, gain=-1e12, verify=False)) == np.inf


def test_a_square_root_squares_to_its_matrix_whatever_the_units(small_plant):
    cost = sample(small_plant()).cost
    root = square_root(cost)
    scale = np.sqrt(np.diag(cost))
    np.testing.assert_allclose(root @ root.T / np.outer(scale, scale), cost / np.outer(scale, scale), atol=1e-12)
