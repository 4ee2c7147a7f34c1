"""Weights of one's own: the gains of python-control and SciPy for them, and one sentence for those that are none."""

import control
import numpy as np
import pytest
from scipy.integrate import quad_vec
from scipy.linalg import expm, solve_discrete_are

from baselines import PersistentLoad, RotorHarmonics, clipped_lqg, h_infinity, lqg, lqr, mpc, rotor_lqg

RANDOM = np.random.default_rng(8).normal(size=(6, 6))
Q, R = RANDOM @ RANDOM.T, np.array([[3e-8, 1e-8], [1e-8, 2e-8]])


def test_the_continuous_design_has_python_controls_gain(small_plant):
    plant = small_plant()
    expected = control.lqr(plant.A, plant.B, Q, R)[0]
    law = lqg(plant, "continuous", Q=Q, R=R)
    np.testing.assert_allclose(-law.state_gain, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
    assert np.abs(law.state_gain - lqg(plant, "continuous").state_gain).max() > 0.1 * np.abs(expected).max()


def sampled_gain(plant):
    """Of the same weights, integrated over an interval by quadrature."""
    n, m = plant.B.shape
    joined = np.block([[plant.A, plant.B], [np.zeros((m, n + m))]])
    weight = np.block([[Q, np.zeros((n, m))], [np.zeros((m, n)), R]])
    cost = quad_vec(lambda t: expm(joined * t).T @ weight @ expm(joined * t), 0.0, plant.control_interval, epsrel=1e-12)[0]
    A, B = np.split(expm(joined * plant.control_interval)[:n], [n], axis=1)
    P = solve_discrete_are(A, B, cost[:n, :n], cost[n:, n:], s=cost[:n, n:])
    return np.linalg.solve(cost[n:, n:] + B.T @ P @ B, B.T @ P @ A + cost[n:, :n])


def test_the_sampled_designs_have_scipys_gain(small_plant):
    plant = small_plant()
    expected = sampled_gain(plant)
    found = {
        "lqr": -lqr(plant, Q=Q, R=R).measurement_gain,
        "clipped_lqg": clipped_lqg(plant, Q=Q, R=R).feedback_gain,
        "mpc": -mpc(plant, Q=Q, R=R).unconstrained_plan[:2],
    }
    for name, gain in found.items():
        np.testing.assert_allclose(gain, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max(), err_msg=name)


@pytest.mark.parametrize(
    "law",
    [
        lqg,
        lambda plant, **weights: lqg(plant, "continuous", **weights),
        lambda plant, **weights: lqr(plant, PersistentLoad(), **weights),
        lambda plant, **weights: rotor_lqg(plant, RotorHarmonics(200.0), **weights),
        h_infinity,
    ],
)
def test_the_plants_own_weights_are_the_default_and_dear_voltages_make_small_gains(small_plant, law):
    plant = small_plant()
    own, same = law(plant), law(plant, Q=plant.state_weight, R=plant.input_weight)
    np.testing.assert_array_equal(own.state_gain, same.state_gain)
    dear = law(plant, R=1e3 * plant.input_weight)
    assert np.linalg.norm(dear.measurement_gain) < 0.5 * np.linalg.norm(own.measurement_gain)


@pytest.mark.parametrize(
    ("weights", "sentence"),
    [
        ({"Q": np.eye(5)}, r"Q has shape \(5, 5\), but must hold finite numbers in shape \(6, 6\)"),
        ({"R": [1.0, 1.0]}, r"R has shape \(2,\)"),
        ({"Q": np.full((6, 6), np.nan)}, "Q .* finite numbers"),
        ({"Q": "energy"}, "Q = 'energy' must be a matrix of real numbers"),
        ({"Q": np.eye(6) + np.eye(6, k=1)}, "Q differs from its transpose by 1, but must be symmetric"),
        ({"Q": np.diag([1.0, 1.0, 1.0, 1.0, 1.0, -0.1])}, "Q has the eigenvalue -0.1, but must be positive semidefinite"),
        ({"R": np.diag([1.0, 0.0])}, "R has the eigenvalue 0, but must be positive definite"),
    ],
)
def test_weights_that_are_none_are_refused_by_name(small_plant, weights, sentence):
    for law in (lqg, lqr):
        with pytest.raises(ValueError, match=sentence):
            law(small_plant(), **weights)
