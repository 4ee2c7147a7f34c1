"""Weights of hypotheses against Bayes' rule in one piece, and the switching estimator's against Blom and Bar-Shalom."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from baselines import Hypothesis, PersistentLoad, multiple_model
from beamenv.plant.plant import sample
from tests.baselines.hypotheses import BLIND, CASES, IDLE, OPEN, hypotheses, model_by_hand, readings, run, slower


@pytest.fixture(name="plant", scope="module")
def _plant(small_plant):
    return small_plant(**OPEN)


def log_density(plant, given, volts, delay=0, gain=(1.0, 1.0), seen=(1.0, 1.0), bias=(0.0, 0.0), missing=()):
    """Of all readings at once, from the joint Gaussian of loads, noise and bias; ``missing`` are places in the flat sequence."""
    A, B, C, W, V, start = model_by_hand(plant, PersistentLoad(), 12.0)
    C, steps, n = np.array(seen)[:, None] * C, len(given), len(A)
    mean, x = np.zeros((steps, 2)), np.zeros(n)
    spread = np.zeros((steps, n, steps, n))
    S = start
    for k in range(steps):
        mean[k] = C @ x
        x = A @ x + B @ (np.array(gain) * volts[k - delay] if k >= delay else np.zeros(2))
        spread[k, :, k] = S
        for j in range(k + 1, steps):
            spread[j, :, k] = A @ spread[j - 1, :, k]
            spread[k, :, j] = spread[j, :, k].T
        S = A @ S @ A.T + W
    covariance = np.einsum("pi,kilj,qj->kplq", C, spread, C)
    b = (np.array(bias) * plant.sensor_full_scale) ** 2
    for k in range(steps):
        covariance[k, :, k] += V
        for j in range(steps):
            covariance[k, :, j] += np.diag(b) * np.exp(-abs(k - j) * plant.control_interval / 10.0)
    kept = np.setdiff1d(np.arange(2 * steps), missing)
    scale = 1e-6
    covariance = covariance.reshape(2 * steps, -1)[np.ix_(kept, kept)] / scale**2
    return multivariate_normal.logpdf(given.ravel()[kept] / scale, mean.ravel()[kept] / scale, covariance)


def posterior(prior, logs):
    weights = np.array(prior) * np.exp(np.array(logs) - max(logs))
    return weights / weights.sum()


def test_weights_are_bayes_rule_with_the_density_of_all_readings_at_once(plant):
    given = readings(12)
    those = [*hypotheses(plant), Hypothesis(slower(plant), load=PersistentLoad(), deflection=12.0, prior=9.0)]
    law = multiple_model(those, floor=0.0)
    volts, memories = run(law, given)
    for steps in (1, 2, 5, 12):
        logs = [log_density(plant, given[:steps], volts, **case) for case in CASES]
        logs.append(log_density(slower(plant), given[:steps], volts))
        np.testing.assert_allclose(law.weights(memories[steps - 1]), posterior([1, 2, 3, 4, 5, 9], logs), rtol=2e-5, atol=1e-12)


def test_a_reading_that_is_shown_again_exactly_is_lost_to_weights_and_estimates(plant):
    given = readings(6)
    given[5, 1] = given[4, 1]
    law = multiple_model(hypotheses(plant, holds_lost_readings=True), floor=0.0)
    volts, memories = run(law, given)
    logs = [log_density(plant, given, volts, **case, missing=[11]) for case in CASES]
    np.testing.assert_allclose(law.weights(memories[5]), posterior([1, 2, 3, 4, 5], logs), rtol=2e-5)
    plain = multiple_model(hypotheses(plant), floor=0.0)
    kept = [log_density(plant, given, volts, **case) for case in CASES]
    np.testing.assert_allclose(plain.weights(run(plain, given)[1][5]), posterior([1, 2, 3, 4, 5], kept), rtol=2e-5)
    alone = multiple_model(hypotheses(plant, holds_lost_readings=True)[:1], rate_weight=0.0)
    memory = alone.recall(run(alone, given)[1][5][None])
    before = alone.recall(run(alone, given[:5])[1][4][None]).predicted[0, 0]
    A, B, C, _, V, S = model_by_hand(plant, PersistentLoad(), 12.0)
    for _ in range(5):
        S = A @ (S - S @ C.T @ np.linalg.solve(C @ S @ C.T + V, C @ S)) @ A.T + model_by_hand(plant, PersistentLoad())[3]
    one = C[:1]
    x = before + (S @ one.T / (one @ S @ one.T + V[:1, :1]))[:, 0] * (given[5, 0] - one @ before)
    x = A @ x + B @ memory.voltages[0, 0] if len(memory.voltages[0]) else A @ x - B @ alone.state_gain[0] @ x
    np.testing.assert_allclose(memory.predicted[0, 0], x, rtol=1e-6, atol=1e-9 * np.abs(x).max())


def moved(law, plant, steps, faults=(), released_from=0.0):
    """Weights along an episode of a plant with white loads and noise; ``faults`` change it as [(step, plant, delay)].

    It starts in the deflection under loads (N/m) in lag and flap.
    """
    random, truths = np.random.default_rng(0), [(0, plant, 0), *faults]
    x, memory, asked, found = -np.linalg.solve(plant.A, plant.disturbance_input @ np.full(2, released_from)), None, [], []
    loads, noise = np.sqrt(np.diag(plant.process_noise / plant.control_interval)), 0.02 * 2e-5
    for k in range(steps):
        _, now, delay = [truth for truth in truths if truth[0] <= k][-1]
        held, scale = sample(now), now.sensor_full_scale
        action, memory = law.predict((held.C @ x + noise * random.normal(size=2)) / scale, memory)
        asked.append(action * law.instruments.voltage_scale)
        found.append(law.weights(memory))
        x = held.A @ x + held.disturbance_input @ (loads * random.normal(size=2))
        x += held.B @ asked[k - delay] if k >= delay else 0.0
    return np.array(found)


@pytest.mark.parametrize("truth", range(3))
def test_the_hypothesis_that_is_right_gets_all_the_weight(plant, truth):
    those = [Hypothesis(plant), Hypothesis(slower(plant)), Hypothesis(plant, sensor_gain=BLIND)]
    law = multiple_model(those)
    weights = moved(law, those[truth].faulty_plant, 300)
    assert weights[0].max() < 0.99
    assert weights[-1, truth] > 0.9999
    assert weights.min() > 0.9e-6


def test_delay_is_found_as_soon_as_voltages_tell(plant):
    law = multiple_model([Hypothesis(plant, delay=d, deflection=20.0) for d in range(4)])
    weights = moved(law, plant, 300, [(0, plant, 2)], released_from=20.0)
    assert weights[-1, 2] > 0.999


def test_with_nothing_to_follow_anything_the_switching_estimator_is_magill_s(plant):
    given = readings(40)
    plain = multiple_model(hypotheses(plant), floor=0.0)
    switching = multiple_model(hypotheses(plant), transition=np.eye(5), floor=0.0)
    np.testing.assert_allclose(run(switching, given)[0], run(plain, given)[0], rtol=1e-6, atol=1e-4)


def test_the_switching_estimator_mixes_as_blom_and_bar_shalom_do(plant):
    markov = np.array([[0.9, 0.1], [0.3, 0.7]])
    those = [Hypothesis(plant, prior=3.0), Hypothesis(plant, sensor_gain=BLIND)]
    law = multiple_model(those, transition=markov, rate_weight=0.0, floor=0.0)
    bank, A, B = law.bank, sample(plant).A, sample(plant).B
    C = [plant.C, np.array(BLIND)[:, None] * plant.C]
    x, weights = [np.zeros(6), np.zeros(6)], np.array([0.75, 0.25])
    for k, (reading, volts) in enumerate(zip(readings(30), run(law, readings(30))[0], strict=True)):
        k = min(k, len(bank.cross) - 1)
        likelihood = [multivariate_normal.pdf(reading * 1e7, C[j] @ x[j] * 1e7, bank.covariance[k, j] * 1e14) for j in (0, 1)]
        x = [x[j] + bank.cross[k, j].T @ np.linalg.solve(bank.covariance[k, j], reading - C[j] @ x[j]) for j in (0, 1)]
        weights = weights * likelihood / (weights @ likelihood)
        asked = -sum(weights[j] * law.state_gain[j] @ x[j] for j in (0, 1))
        np.testing.assert_allclose(volts, asked, rtol=1e-7, atol=1e-7 * np.abs(asked).max())
        following = [weights[0] * markov[0, j] + weights[1] * markov[1, j] for j in (0, 1)]
        mixed = [(weights[0] * markov[0, j] * x[0] + weights[1] * markov[1, j] * x[1]) / following[j] for j in (0, 1)]
        x, weights = [A @ mixed[j] + B @ volts for j in (0, 1)], np.array(following)


def test_a_sensor_that_dies_in_mid_episode_is_found_sooner_by_the_switching_estimator(plant):
    those = [Hypothesis(plant), Hypothesis(plant, sensor_gain=BLIND), Hypothesis(plant, sensor_gain=IDLE)]
    stay = 0.998
    markov = np.full((3, 3), (1.0 - stay) / 2.0) + (stay - (1.0 - stay) / 2.0) * np.eye(3)
    dies = [(200, those[1].faulty_plant, 0)]
    switching = moved(multiple_model(those, transition=markov), plant, 400, dies)
    fixed = moved(multiple_model(those, floor=0.0), plant, 400, dies)
    assert switching[190, 0] > 0.9
    found = [int(np.argmax(weights[200:, 1] > 0.5)) for weights in (switching, fixed)]
    assert 0 < found[0] < 30
    assert found[1] == 0 or found[1] > 2 * found[0]
    assert switching[-1, 1] > 0.9


def test_hypotheses_that_nothing_leads_to_are_left_and_the_others_decide(small_plant):
    """As where next to nothing does."""
    those = [Hypothesis(small_plant(), **fault) for fault in ({}, {"actuator_gain": (0.0, 1.0)}, {"sensor_gain": (0.0, 1.0)})]
    matrices = [
        np.array([[share, 1.0 - share, 0.0], [share, 0.9 - share, 0.1], [share, 0.5 - share, 0.5]]) for share in (0.0, 1e-14)
    ]
    never, hardly = (multiple_model(those, transition=matrix, floor=0.0) for matrix in matrices)
    one = other = None
    for seen in 0.01 * np.random.default_rng(0).normal(size=(40, 3, 2)):
        action, one = never.predict(seen, one)
        wanted, other = hardly.predict(seen, other)
        np.testing.assert_allclose(action, wanted, atol=1e-6)
    assert (never.weights(one)[:, 0] < 1e-300).all() and np.abs(action).max() > 1e-3
