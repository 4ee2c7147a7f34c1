"""Riccati equations against hand-solved scalars, their own residual, and python-control."""

import control
import numpy as np
import pytest

from baselines.design.riccati import kalman_filter, regulator, sampled_kalman_filter, sampled_regulator
from beamenv.plant.plant import sample


def test_scalar_regulator_solves_the_quadratic_by_hand():
    a, b, q, r = -3.0, 2.0, 5.0, 0.7
    P, K = regulator(*(np.array([[value]]) for value in (a, b, q, r)))
    by_hand = r / b**2 * (a + np.sqrt(a**2 + b**2 * q / r))
    assert P[0, 0] == pytest.approx(by_hand, rel=1e-12)
    assert K[0, 0] == pytest.approx(b * by_hand / r, rel=1e-12)


def test_scalar_filter_of_a_random_walk_has_the_golden_ratio():
    one = np.ones((1, 1))
    predicted, gain = sampled_kalman_filter(one, one, one, one)
    golden = (1 + np.sqrt(5)) / 2
    assert predicted[0, 0] == pytest.approx(golden, rel=1e-12)
    assert gain[0, 0] == pytest.approx(golden / (1 + golden), rel=1e-12)


def test_continuous_solutions_satisfy_the_thesis_equations(small_plant):
    plant = small_plant()
    A, B, C, E = plant.A, plant.B, plant.C, plant.disturbance_input
    W = E @ plant.process_noise @ E.T
    P, K = regulator(A, B, plant.state_weight, plant.input_weight)
    S, L = kalman_filter(A, C, W, plant.sensor_noise)
    control_residual = P @ A + A.T @ P + plant.state_weight - P @ B @ np.linalg.solve(plant.input_weight, B.T @ P)
    filter_residual = A @ S + S @ A.T + W - S @ C.T @ np.linalg.solve(plant.sensor_noise, C @ S)
    assert np.abs(control_residual).max() < 1e-9
    assert np.abs(filter_residual).max() < 1e-9 * np.abs(W).max()
    np.testing.assert_allclose(K, np.linalg.solve(plant.input_weight, B.T @ P), rtol=1e-7)
    np.testing.assert_allclose(L, S @ C.T @ np.linalg.inv(plant.sensor_noise), rtol=1e-7)


def test_the_filter_equation_needs_the_transpose_that_thesis_5_21_lacks(small_plant):
    plant = small_plant()
    A, C, E = plant.A, plant.C, plant.disturbance_input
    W = E @ plant.process_noise @ E.T
    S, _ = kalman_filter(A, C, W, plant.sensor_noise)
    as_printed = A @ S + S @ A + W - S @ C.T @ np.linalg.solve(plant.sensor_noise, C @ S)
    assert np.abs(as_printed).max() > 1e-2 * np.abs(A @ S).max()


def test_two_loads_on_many_modes_leave_a_positive_error_covariance(small_plant):
    plant = small_plant()
    held = sample(plant)
    W = held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    assert np.linalg.matrix_rank(W) == 2
    S, L = sampled_kalman_filter(held.A, held.C, W, held.sensor_noise)
    residual = held.A @ (S - L @ held.C @ S) @ held.A.T + W - S
    assert np.abs(residual).max() < 1e-9 * np.abs(S).max()
    assert np.linalg.eigvalsh(S).min() > 0


def test_sampled_gains_agree_with_python_control_whose_dlqe_gives_the_predictor_gain(small_plant):
    held = sample(small_plant())
    W = held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    P, K = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    S, L = sampled_kalman_filter(held.A, held.C, W, held.sensor_noise)
    K_control, P_control, _ = control.dlqr(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight, method="scipy")
    L_control, S_control, _ = control.dlqe(
        held.A, held.disturbance_input, held.C, held.process_noise, held.sensor_noise, method="scipy"
    )
    np.testing.assert_allclose(P, P_control, rtol=1e-6, atol=1e-9 * np.abs(P).max())
    np.testing.assert_allclose(K, K_control, rtol=1e-6, atol=1e-8 * np.abs(K).max())
    np.testing.assert_allclose(S, S_control, rtol=1e-6, atol=1e-8 * np.abs(S).max())
    np.testing.assert_allclose(held.A @ L, L_control, rtol=1e-6, atol=1e-7 * np.abs(L).max())
    assert np.abs(L - L_control).max() > 0.1 * np.abs(L).max()
