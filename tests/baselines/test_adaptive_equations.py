"""The adaptive law against its equations, written down once more for one blade: no batch, no shared code."""

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from baselines import AdaptationSettings, adaptive_neural, full_order_lqg
from beamenv.plant.plant import sample

SETTINGS = AdaptationSettings(forces=2, hidden=3, inner_rate=0.4, forgetting=3e-3, authority=0.3)


@pytest.fixture(scope="module")
def law(small_plant):
    plant = small_plant()
    return adaptive_neural(plant, full_order_lqg(plant), SETTINGS).in_physical_units()


@pytest.fixture(scope="module")
def readings():
    """(T, p), A: what excites itself, beyond full scale at the end."""
    time = np.arange(200)[:, None]
    return 2e-5 * (0.2 + 0.01 * time) * np.sin(0.1 * time + np.array([0.0, 1.0]))


def by_the_equations(law, readings):
    """Voltages (T, m) and energies (T,), line by line as the docstrings of the law, its model and its learning have them."""
    model, base, rates = law.model, law.base, law.learning
    A, B, C, D, K, L = (
        model.transition,
        model.voltage_input,
        model.output,
        model.force_input,
        model.feedback_gain,
        model.kalman_gain,
    )
    n, q, h, p = len(A), D.shape[1], len(law.start), len(C)
    of = np.arange(h) // (h // q)
    slow, low, high = A - A @ L @ C, *law.instruments.voltage_limits
    x, delta, foreseen, W, V, b = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(h), np.zeros((h, 2)), np.zeros(p)
    xi, units, by_units, by_inputs = np.zeros(base.order), np.zeros(h), np.zeros((h, n)), np.zeros((q, 2, n))
    volts, energies = [], []
    for y in readings:
        epsilon = y - np.clip(C @ x, -model.full_scale, model.full_scale)
        error = foreseen + model.observer_gain @ (epsilon - C @ foreseen)
        energies.append(error @ model.lyapunov @ error)
        felt = [model.whitening @ C @ each for each in by_units]
        e = model.whitening @ (epsilon + C @ delta) - b - sum(W[i] * felt[i] for i in range(h))
        d = 1.0 + p + sum(each @ each for each in felt)
        kept = max(1.0 - rates.forgetting * np.sqrt(energies[-1]), 0.0)
        slopes = [W[i] * (1.0 - (units[i] / rates.saturation) ** 2) for i in range(h)]
        through = [[model.whitening @ C @ by_inputs[of[i], k] @ e / d for k in range(2)] for i in range(h)]
        V = kept * V + rates.inner_rate * np.array([[slopes[i] * each for each in through[i]] for i in range(h)])
        W = kept * W + rates.outer_rate * np.array([each @ e / d for each in felt])
        W, V = W / max(1.0, np.linalg.norm(W) / rates.outer_bound), V / max(1.0, np.linalg.norm(V) / rates.inner_bound)
        b = b + rates.bias_rate * e / d
        x, delta = x + L @ epsilon, delta - L @ C @ delta
        adaptive = np.clip(K @ delta, -law.authority * model.drive, law.authority * model.drive)
        u = np.clip(base.state_gain @ xi + base.measurement_gain @ y - adaptive, low, high)
        xi = base.transition @ xi + base.measurement_input @ y + base.voltage_input @ u
        inputs = (model.shown.T @ x).reshape(q, 2)
        units = np.array([rates.saturation * np.tanh((law.start[i] + V[i]) @ inputs[of[i]] / rates.saturation) for i in range(h)])
        forces = np.array([sum(W[i] * units[i] for i in range(h) if of[i] == j) for j in range(q)])
        x, delta, foreseen = A @ x + B @ u + D @ forces, A @ delta + D @ forces, A @ (error - L @ epsilon)
        by_units = np.array([slow @ by_units[i] + D[:, of[i]] * units[i] for i in range(h)])
        by_inputs = np.array([[slow @ by_inputs[j, k] + D[:, j] * inputs[j, k] for k in range(2)] for j in range(q)])
        volts.append(u)
    return np.array(volts), np.array(energies)


def test_voltages_and_energies_are_those_of_its_equations(law, readings):
    volts, energies, memory = [], [], None
    for seen in readings:
        action, memory = law.predict(seen, memory)
        volts.append(action)
        energies.append(law.adaptation(memory).error_energy)
    expected_volts, expected_energies = by_the_equations(law, readings)
    drive = law.model.drive.max()
    assert np.abs(np.array(volts) - law.base.measurement_gain @ readings[0]).max() > 0.1 * drive
    np.testing.assert_allclose(volts, expected_volts, atol=1e-8 * drive)
    np.testing.assert_allclose(energies, expected_energies, rtol=1e-8)


def test_what_the_network_does_is_seen_in_the_voltages(law, readings):
    """So that the test above is one of the network too."""
    learning, _ = by_the_equations(law, readings)
    memory, without = None, []
    for seen in readings:
        action, memory = law.switched(False).predict(seen, memory)
        without.append(action)
    assert np.abs(learning - np.array(without)).max() > 0.05 * law.model.drive.max()


def test_an_errors_energy_is_the_innovations_squared_that_it_will_cause(law):
    model = law.model
    error, total = np.random.default_rng(0).normal(size=len(model.transition)), 0.0
    expected = float(model.energy(error[None])[0])
    for _ in range(4000):
        innovation = model.output @ error
        total += float(np.sum((model.whitening @ innovation) ** 2))
        error = model.transition @ (error - model.kalman_gain @ innovation)
    assert expected == pytest.approx(total, rel=1e-6)


def test_a_force_of_one_bends_its_mode_by_a_tenth_of_what_is_usual(law):
    """A lasting one: D by the design at rest, against the units in which the network is shown deflections."""
    model, r = law.model, len(law.model.transition) // 2
    held = np.linalg.solve(np.eye(2 * r) - model.transition, model.force_input)
    for mode in range(2):
        assert held[mode, mode] * model.shown[mode, 2 * mode] == pytest.approx(0.1, rel=1e-9)
        assert model.shown[r + mode, 2 * mode + 1] > 0.0 and np.count_nonzero(model.shown[:, 2 * mode : 2 * mode + 2]) == 2


def test_only_modes_whose_forces_are_foreseen_are_driven(law):
    gain = law.model.feedback_gain
    assert np.all(gain[:, [0, 1, 3, 4]] != 0.0) and not gain[:, [2, 5]].any()


def test_error_observer_is_the_kalman_filter_of_errors_that_unknown_forces_drive(law, small_plant):
    held, model = sample(small_plant()), law.model
    loads = held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    noise = np.asarray(small_plant().sensor_noise) / held.interval
    A, C, unit = held.A, held.C, 1e5  # currents of some 1e-5 A
    S = solve_discrete_are(A.T, unit * C.T, loads + model.force_input @ model.force_input.T, unit**2 * noise)
    expected = np.linalg.solve(C @ S @ C.T + noise, C @ S).T
    np.testing.assert_allclose(model.observer_gain, expected, rtol=1e-6, atol=1e-9 * np.abs(expected).max())
    assert np.abs(expected - model.kalman_gain).max() > 0.01 * np.abs(expected).max()
