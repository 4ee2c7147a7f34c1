"""The network's learning: what theory promises where theory's conditions are met."""

import numpy as np
import pytest

from baselines.design.hidden_layer import (
    Filtered,
    Learning,
    Weights,
    first_inner_weights,
    hidden_units,
    learned,
    norms,
    onto_ball,
    outputs,
    prediction_error,
)

INTERVAL, UNITS = 0.02, 6
RESTS = {"bias_rate": 0.0, "forgetting": 0.0, "outer_bound": 1e6, "inner_bound": 1e6}


def self_excited_against_its_model(rate, steps=4000, inner_rate=0.0):
    """E and W − W* along an oscillator that excites itself up to a limit cycle, as flutter does; its position is read.

    What excites it is not in the model, and a network of weights W* is it.
    """
    A, D, C = (
        np.array([[1.0, INTERVAL], [-INTERVAL, 1.0 - 0.5 * INTERVAL]]),
        np.array([[0.0], [INTERVAL]]),
        np.array([[100.0, 0.0]]),
    )
    gain = np.array([[0.3], [0.4]]) / 100.0
    loop = (A - A @ gain @ C).T
    start = first_inner_weights(1, UNITS, 0)
    grid = np.random.default_rng(0).uniform(-2.5, 2.5, (400, 1, 2))
    idle = Weights(np.zeros((1, UNITS)), np.zeros((1, UNITS, 2)), np.zeros((1, 1)))
    shown = hidden_units(start, Weights(idle.outer, np.zeros((400, UNITS, 2)), idle.bias), grid, 1.0)
    wanted = np.linalg.lstsq(shown, np.tanh(1.2 * grid[:, 0, 1]), rcond=1e-2)[0]
    learning = Learning(outer_rate=rate, inner_rate=inner_rate, saturation=1.0, **RESTS)
    weights, x, model, departure = idle, np.array([[0.5, 0.0]]), np.array([[0.5, 0.0]]), np.zeros((1, 2))
    by_units, by_inputs, errors, distances = np.zeros((1, UNITS, 2)), np.zeros((1, 2, 2)), [], []
    units = np.zeros((1, UNITS))
    for _ in range(steps):
        felt = Filtered(by_units @ C.T, (by_inputs @ C.T).reshape(1, 1, 2, 1))
        error = prediction_error(weights, felt, (x - model) @ C.T + departure @ C.T)
        errors.append(float(np.abs(x - model).max()))
        distances.append(float(((weights.outer - wanted) ** 2).sum()))
        weights = learned(weights, felt, units, error, np.zeros(1), learning)
        inputs = x[:, None]
        units = hidden_units(start, weights, inputs, 1.0)
        foreseen = outputs(weights, units, 1) @ D.T
        true = hidden_units(start, idle, inputs, 1.0) @ wanted[:, None] @ D.T
        model = model @ A.T + (x - model) @ C.T @ (A @ gain).T + foreseen
        x, departure = x @ A.T + true, departure @ loop + foreseen
        by_units = by_units @ loop + units[..., None] * D.T
        by_inputs = by_inputs @ loop + inputs.reshape(1, 2, 1) * D.T
    return np.array(errors), np.array(distances)


@pytest.mark.parametrize("rate", [0.1, 1.0, 1.9])
def test_the_lyapunov_function_falls_at_every_instant_where_uncertainty_is_matched(rate):
    errors, distances = self_excited_against_its_model(rate)
    assert errors[:500].max() > 1e-3  # there is something to learn
    assert np.diff(distances).max() <= 1e-12 * distances[0]
    assert distances[-1] < distances[0]


def test_steps_beyond_what_is_promised_let_it_rise():
    _, distances = self_excited_against_its_model(4.0, steps=1000)
    assert np.diff(distances).max() > 1e-6 * distances[0]


@pytest.mark.parametrize("inner_rate", [0.0, 0.1])
def test_the_error_falls_to_a_fifth_of_what_it_is_without_learning(inner_rate):
    with_learning, _ = self_excited_against_its_model(0.1, inner_rate=inner_rate)
    without, _ = self_excited_against_its_model(0.0)
    assert with_learning[-1000:].mean() < 0.2 * without[-1000:].mean()


def random_step(generator, learning, weights, q=2, each=3, p=2):
    size = 10.0 ** generator.uniform(-3, 6)
    felt = Filtered(size * generator.normal(size=(4, q * each, p)), size * generator.normal(size=(4, q, 2, p)))
    units = learning.saturation * np.tanh(generator.normal(size=(4, q * each)))
    return learned(weights, felt, units, generator.normal(size=(4, p)) * 10.0 ** generator.uniform(-3, 6), np.ones(4), learning)


def test_weights_stay_on_their_balls_whatever_is_read():
    generator = np.random.default_rng(1)
    learning = Learning(1.9, 1.9, 1.0, 1e-3, 2.0, 0.5, 3.0)
    weights = Weights(np.zeros((4, 6)), np.zeros((4, 6, 2)), np.zeros((4, 2)))
    largest = np.zeros(2)
    for _ in range(300):
        weights = random_step(generator, learning, weights)
        assert norms(weights.outer).max() <= 2.0 * (1.0 + 1e-12) and norms(weights.inner).max() <= 0.5 * (1.0 + 1e-12)
        largest = np.maximum(largest, [norms(weights.outer).max(), norms(weights.inner).max()])
    np.testing.assert_allclose(largest, [2.0, 0.5])  # the balls were met


def test_a_projection_leaves_what_is_inside_and_keeps_directions():
    inside, outside = np.full((1, 2, 2), 0.1), np.full((1, 2, 2), 3.0)
    np.testing.assert_array_equal(onto_ball(inside, 1.0), inside)
    np.testing.assert_allclose(onto_ball(outside, 1.0), np.full((1, 2, 2), 0.5))


def test_inner_weights_learn_along_the_gradient_of_what_the_outputs_do():
    """By differences: d(eᵀ Wᵀ σ(Vᵀ μ))/dV, of inputs that are felt as they are."""
    generator, saturation = np.random.default_rng(2), 1.5
    start, inputs, error = first_inner_weights(1, 3, 0), generator.normal(size=(1, 1, 2)), np.array([[0.7]])
    weights = Weights(generator.normal(size=(1, 3)), np.zeros((1, 3, 2)), np.zeros((1, 1)))
    units = hidden_units(start, weights, inputs, saturation)
    learning = Learning(outer_rate=0.0, inner_rate=1e-3, saturation=saturation, **RESTS)
    after = learned(weights, Filtered(units[..., None], inputs[..., None]), units, error, np.zeros(1), learning)
    slope = np.zeros((3, 2))
    for i, j in np.ndindex(slope.shape):
        moved = np.zeros((1, 3, 2))
        moved[0, i, j] = 1e-6
        shifted = weights._replace(inner=moved)
        gained = outputs(shifted, hidden_units(start, shifted, inputs, saturation), 1) - outputs(weights, units, 1)
        slope[i, j] = 0.7 * gained.item() / 1e-6
    np.testing.assert_allclose(after.inner[0], 1e-3 / (2.0 + (units**2).sum()) * slope, rtol=1e-5)
