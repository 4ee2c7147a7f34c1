"""Hypotheses on a small plant, and their models written anew."""

from dataclasses import replace

import numpy as np

from baselines import Hypothesis, PersistentLoad
from baselines.laws.lqg import known_sensor_noise
from beamenv.plant.plant import sample

OPEN = {"sensor_full_scale": np.array([0.01, 0.01]), "voltage_limits": np.array([[-1e9, -1e9], [1e9, 1e9]])}
"""Instruments that clip nothing, for what is true while nothing clips."""
BLIND, IDLE = (0.0, 1.0), (1.0, 0.0)


def slower(plant, ratio=0.8):
    n = len(plant.A) // 2
    A = plant.A.copy()
    A[:n, n:] *= ratio
    A[n:, :n] *= ratio
    return replace(plant, A=A, natural_frequencies=ratio * plant.natural_frequencies)


def readings(steps, rows=(), seed=3):
    return 1e-6 * np.random.default_rng(seed).normal(size=(steps, *rows, 2))


def run(law, given, starts=None):
    """Voltages and memories, for readings in A."""
    memory, actions, memories = None, [], []
    for k, reading in enumerate(given):
        action, memory = law.predict(reading / law.instruments.measurement_scale, memory, None if starts is None else starts[k])
        actions.append(action * law.instruments.voltage_scale)
        memories.append(memory)
    return np.array(actions), memories


def model_by_hand(plant, load, deflection=0.0):
    """A, B, C, W, V, S₀ with the load's two states behind those of the blade, written anew."""
    held, (n, m), a = sample(plant), plant.B.shape, np.exp(-plant.control_interval / load.duration)
    A = np.zeros((n + 2, n + 2))
    A[:n, :n], A[:n, n:], A[n:, n:] = held.A, held.disturbance_input, a * np.eye(2)
    W = np.zeros_like(A)
    W[:n, :n] = held.disturbance_input @ (plant.process_noise / plant.control_interval) @ held.disturbance_input.T
    W[n:, n:] = (1.0 - a**2) * load.magnitude**2 * np.eye(2)
    start = np.zeros_like(A)
    for direction in np.eye(2):
        bent = np.linalg.solve(plant.A, plant.disturbance_input @ direction * deflection)
        start[:n, :n] += np.outer(bent, bent)
    start[n:, n:] = load.magnitude**2 * np.eye(2)
    B, C = np.vstack([held.B, np.zeros((2, m))]), np.hstack([plant.C, np.zeros((len(plant.C), 2))])
    return A, B, C, W, known_sensor_noise(plant) / plant.control_interval, start


CASES = [{}, {"delay": 2}, {"gain": IDLE}, {"seen": BLIND}, {"bias": (1e-4, 0.0)}]


def hypotheses(plant, **more):
    names = {"delay": "delay", "gain": "actuator_gain", "seen": "sensor_gain", "bias": "sensor_bias"}
    own = {"load": PersistentLoad(), "deflection": 12.0, **more}
    faults = [{names[name]: value for name, value in case.items()} for case in CASES]
    return [Hypothesis(plant, prior=1.0 + k, **own, **fault) for k, fault in enumerate(faults)]
