"""The network's learning: what theory promises where theory's conditions are met."""

import numpy as np
import pytest
from scipy.linalg import solve_discrete_lyapunov

from baselines.design.hidden_layer import (
    Learning,
    Weights,
    first_inner_weights,
    hidden_units,
    learned,
    norms,
    onto_ball,
    outputs,
)

INTERVAL = 0.02
HIDDEN = 12


def van_der_pol_against_its_model(rate, steps=4000):
    """V = EᵀPE + ‖W − W*‖² DᵀPD (1 + a)/γ along a van der Pol oscillator whose damping the model does not know, and W* does."""
    A = np.array([[1.0, INTERVAL], [-INTERVAL, 1.0]])
    D = np.array([[0.0], [INTERVAL]])
    loop = A - 0.1 * np.eye(2)
    P = solve_discrete_lyapunov(loop.T, np.eye(2))
    start = 0.7 * first_inner_weights(3, HIDDEN, 0)
    grid = np.stack([np.ones(400), *np.random.default_rng(0).uniform(-2.5, 2.5, (2, 400))], axis=1)
    wanted = np.linalg.lstsq(np.tanh(grid @ start), (1.0 - grid[:, 1:2] ** 2) * grid[:, 2:], rcond=1e-2)[0]
    felt = float((D.T @ P @ D)[0, 0])
    learning = Learning(rate, 0.0, 0.0, 1e6, 1.0, activity=HIDDEN)  # no tanh is beyond 1
    weights = Weights(np.zeros((1, HIDDEN, 1)), np.zeros((1, 3, HIDDEN)))
    x, model, energies, distances = np.array([[0.5, 0.0]]), np.zeros((1, 2)), [], []
    for _ in range(steps):
        inputs = np.hstack([[[1.0]], x])
        units, error = hidden_units(start, weights, inputs), x - model
        energies.append(float((error @ P @ error.T)[0, 0]))
        distances.append(float(((weights.outer[0] - wanted) ** 2).sum()))
        model = x @ A.T - error @ loop.T + outputs(weights, units) @ D.T
        x = x @ A.T + units @ wanted @ D.T
        weights = learned(weights, inputs, units, (x - model) @ P @ D / felt, np.zeros(1), learning)
    return np.array(energies), np.array(distances), felt * (1.0 + HIDDEN)


def test_the_lyapunov_function_falls_at_every_instant_where_uncertainty_is_matched():
    rate = 0.2
    energies, distances, weight = van_der_pol_against_its_model(rate)
    whole = energies + distances * weight / rate
    assert energies.max() > 0.01  # something is to be learned
    assert np.diff(whole).max() <= 1e-12 * whole[0]
    assert whole[-1] < whole[0]


def test_steps_beyond_what_is_promised_let_it_rise():
    energies, distances, weight = van_der_pol_against_its_model(1.0, steps=1000)
    assert np.diff(energies + distances * weight).max() > 0.0


def test_the_error_falls_to_a_fiftieth_of_what_it_is_without_learning():
    with_learning, *_ = van_der_pol_against_its_model(0.2)
    without, *_ = van_der_pol_against_its_model(0.0)
    assert with_learning[-1000:].mean() < 0.02 * without[-1000:].mean()


def test_weights_stay_on_their_balls_whatever_is_read():
    generator = np.random.default_rng(1)
    learning = Learning(1.0, 1.0, 1e-3, 2.0, 0.5, activity=1.0)
    start = first_inner_weights(5, 7, 3)
    weights = Weights(np.zeros((4, 7, 3)), np.zeros((4, 5, 7)))
    largest = 0.0
    for _ in range(300):
        inputs = generator.normal(size=(4, 5)) * 10.0 ** generator.uniform(-3, 6)
        direction, error = generator.normal(size=(4, 3)) * 10.0 ** generator.uniform(-3, 6), generator.uniform(0.0, 1e3, 4)
        weights = learned(weights, inputs, hidden_units(start, weights, inputs), direction, error, learning)
        assert norms(weights.outer).max() <= 2.0 * (1.0 + 1e-12) and norms(weights.inner).max() <= 0.5 * (1.0 + 1e-12)
        largest = max(largest, norms(weights.outer).max())
    assert largest == pytest.approx(2.0)  # the ball was met


def test_a_projection_leaves_what_is_inside_and_keeps_directions():
    inside, outside = np.full((1, 2, 2), 0.1), np.full((1, 2, 2), 3.0)
    np.testing.assert_array_equal(onto_ball(inside, 1.0), inside)
    np.testing.assert_allclose(onto_ball(outside, 1.0), np.full((1, 2, 2), 0.5))


def test_learning_is_along_the_gradient_of_what_the_outputs_do():
    """V's step by differences: d(pᵀ Wᵀ σ(Vᵀ μ))/dV."""
    generator = np.random.default_rng(2)
    start, inputs, direction = first_inner_weights(4, 3, 0), generator.normal(size=(1, 4)), generator.normal(size=(1, 2))
    weights = Weights(generator.normal(size=(1, 3, 2)), np.zeros((1, 4, 3)))
    learning = Learning(0.0, 1e-3, 0.0, 1e9, 1e9, activity=1.0)
    after = learned(weights, inputs, hidden_units(start, weights, inputs), direction, np.zeros(1), learning)
    slope = np.zeros((4, 3))
    for i, j in np.ndindex(slope.shape):
        moved = np.zeros((1, 4, 3))
        moved[0, i, j] = 1e-6
        shifted = Weights(weights.outer, moved)
        gained = outputs(shifted, hidden_units(start, shifted, inputs)) - outputs(weights, hidden_units(start, weights, inputs))
        slope[i, j] = float((gained * direction).sum()) / 1e-6
    np.testing.assert_allclose(after.inner[0], 1e-3 / (1.0 + (inputs**2).sum()) * slope, rtol=1e-5)
