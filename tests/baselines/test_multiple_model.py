"""A single hypothesis against textbook recursions: the LQG of its plant, load and delay."""

import numpy as np
import pytest

from baselines import Hypothesis, PersistentLoad, full_order_lqg, multiple_model
from baselines.laws.lqg import sampled_design
from beamenv.plant.plant import sample
from tests.baselines.hypotheses import OPEN, model_by_hand, readings, run


@pytest.fixture(name="plant", scope="module")
def _plant(small_plant):
    return small_plant(**OPEN)


def test_a_hypothesis_alone_is_lqg_with_the_gains_of_the_textbook_s_recursion(plant):
    load = PersistentLoad()
    law = multiple_model([Hypothesis(plant, load=load, deflection=12.0)], rate_weight=0.0)
    A, B, C, W, V, S = model_by_hand(plant, load, 12.0)
    K, x = sampled_design(plant, load)[1].gain, np.zeros(len(A))
    given = readings(len(law.bank.cross) - 1)
    assert len(given) > 30
    for reading, volts in zip(given, run(law, given)[0], strict=True):
        L = S @ C.T @ np.linalg.inv(C @ S @ C.T + V)
        x = x + L @ (reading - C @ x)
        left = np.eye(len(A)) - L @ C
        S = A @ (left @ S @ left.T + L @ V @ L.T) @ A.T + W  # Joseph's form
        np.testing.assert_allclose(volts, -K @ x, rtol=1e-7, atol=1e-7 * np.abs(K @ x).max())
        x = A @ x - B @ K @ x


def test_in_the_long_run_a_hypothesis_alone_is_the_full_order_lqg(plant):
    """On two blades that meet the same noise: all of it that was different at the start has died away."""
    held, ends = sample(plant), []
    for law in (multiple_model([Hypothesis(plant)]), full_order_lqg(plant)):
        random, x, memory, volts = np.random.default_rng(6), np.zeros(6), None, []
        for _ in range(1500):
            reading = held.C @ x + 4e-7 * random.normal(size=2)
            action, memory = law.predict(reading / plant.sensor_full_scale, memory)
            volts.append(action * law.instruments.voltage_scale)
            x = held.A @ x + held.B @ volts[-1] + held.disturbance_input @ random.normal(size=2)
        ends.append(volts)
    size = np.abs(ends[1]).max()
    assert np.abs(np.subtract(*ends))[2:20].max() > 0.01 * size
    np.testing.assert_allclose(ends[0][-50:], ends[1][-50:], rtol=0.0, atol=1e-6 * size)


def test_with_a_lasting_load_the_last_gains_are_those_of_the_full_order_lqg(plant):
    law, plain = multiple_model([Hypothesis(plant, load=PersistentLoad())]), full_order_lqg(plant, load=PersistentLoad())
    L = np.linalg.solve(law.bank.covariance[-1, 0], law.bank.cross[-1, 0]).T
    np.testing.assert_allclose(-law.state_gain[0] @ L, plain.measurement_gain, rtol=1e-7)
    np.testing.assert_allclose(-law.state_gain[0] @ (np.eye(8) - L @ law.bank.output[0].T), plain.state_gain[:, :8], rtol=1e-6)
    np.testing.assert_allclose(-law.voltage_gain[0], plain.state_gain[:, 8:], rtol=1e-9)


def test_where_voltages_come_late_the_gain_is_that_of_dynamic_programming_on_the_voltages_under_way(plant):
    held, d, m, n = sample(plant), 2, 2, len(plant.A)
    law = multiple_model([Hypothesis(plant, delay=d)], rate_weight=1.0)
    A, B = np.zeros((n + d * m, n + d * m)), np.zeros((n + d * m, m))
    A[:n, :n], A[:n, n + m :], A[n + m :, n : n + m], B[n : n + m] = held.A, held.B, np.eye(m), np.eye(m)
    Q, price = np.zeros_like(A), np.diag(np.diag(held.input_weight))
    inner = np.r_[0:n, n + m : n + 2 * m]
    Q[np.ix_(inner, inner)] = held.cost[: n + m, : n + m]
    Q[n : n + m, n : n + m] += price
    N = np.vstack([np.zeros((n, m)), -price, np.zeros((m, m))])
    P = np.zeros_like(A)
    for _ in range(3000):
        K = np.linalg.solve(price + B.T @ P @ B, B.T @ P @ A + N.T)
        P = A.T @ P @ A + Q - (A.T @ P @ B + N) @ K
    np.testing.assert_allclose(law.state_gain[0], K[:, :n], rtol=1e-6, atol=1e-6 * np.abs(K[:, :n]).max())
    np.testing.assert_allclose(law.voltage_gain[0], K[:, n:], rtol=1e-6, atol=1e-6 * np.abs(K[:, n:]).max())
