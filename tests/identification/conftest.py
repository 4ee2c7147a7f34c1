"""A structure of three modes whose motion SciPy's matrix exponential steps: nothing of it comes from what is tested."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import expm

from baselines import Measurement, identify

FREQUENCIES = np.array([60.0, 170.0, 420.0])
DAMPING_RATIOS = np.array([0.012, 0.008, 0.01])
FORCES = np.array([[1.0, 0.5], [0.7, -0.9], [1.1, 0.6]]) * 1e-3  # √J/s per V
RATIO = 1.5  # charge per strain over moment per volt
LOADS = np.array([20.0, 10.0, 15.0]) * 1e-3
INTERVAL = 2e-3
NOISE = 0.05  # of a reading's standard deviation


def structure():
    """A, B, C, E in energy coordinates, x = [ω η, η̇] mode by mode."""
    A = np.zeros((6, 6))
    for k, (omega, zeta) in enumerate(zip(FREQUENCIES, DAMPING_RATIOS, strict=True)):
        A[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = [[0.0, omega], [-omega, -2.0 * zeta * omega]]
    B, E = np.zeros((6, 2)), np.zeros((6, 1))
    B[1::2], E[1::2, 0] = FORCES, LOADS
    C = np.zeros((2, 6))
    C[:, 1::2] = RATIO * FORCES.T
    return A, B, C, E


def sampled(A, B):
    n, m = B.shape
    both = expm(INTERVAL * np.block([[A, B], [np.zeros((m, n + m))]]))
    return both[:n, :n], both[:n, n:]


def record(seed, seconds, noise=NOISE, load=1.0):
    """Voltages, readings and states, row by row, a reading before the voltage of its row."""
    rng = np.random.default_rng(seed)
    A, B, C, E = structure()
    step, held = sampled(A, np.hstack([B, E]))
    rows = round(seconds / INTERVAL)
    volts, loads = 100.0 * rng.standard_normal((rows, 2)), load * rng.standard_normal((rows, 1))
    x, states = np.zeros(6), np.empty((rows, 6))
    for k, inputs in enumerate(np.hstack([volts, loads])):
        states[k] = x
        x = step @ x + held @ inputs
    readings = states @ C.T
    sigma = noise * readings.std(axis=0)
    return SimpleNamespace(volts=volts, readings=readings + sigma * rng.standard_normal(readings.shape), states=states, sigma=sigma)


def measurement(seed, seconds, **options):
    of = record(seed, seconds, **options)
    return Measurement(of.volts, of.readings, INTERVAL, reading_units=("A", "A"))


@pytest.fixture(scope="session")
def measured():
    return measurement(1, 20.0)


@pytest.fixture(scope="session")
def identified(measured):
    return identify(measured, collocated=RATIO)
