"""A blade small enough to be written down: three modes, two collocated patches, two sensors."""

import numpy as np
import pytest

from beamenv.plant.plant import Plant


def small_plant(**changes):
    frequencies = np.array([180.0, 260.0, 700.0])
    r = len(frequencies)
    gyroscopic = np.array([[0.0, 12.0, -3.0], [-12.0, 0.0, 5.0], [3.0, -5.0, 0.0]])
    force = np.array([[2.0e-4, 0.5e-4], [0.7e-4, -1.0e-4], [-1.5e-4, 2.5e-4]])
    A = np.block([[np.zeros((r, r)), np.diag(frequencies)], [-np.diag(frequencies), -gyroscopic - np.diag(0.02 * frequencies)]])
    B = np.vstack([np.zeros((r, 2)), force])
    C = np.hstack([np.zeros((2, r)), 1.6 * force.T])
    full_scale = np.array([2e-5, 2e-5])
    interval = 5e-4
    matrices = {
        "A": A,
        "B": B,
        "C": C,
        "D": np.zeros((2, 2)),
        "disturbance_input": np.vstack([np.zeros((r, 2)), np.array([[0.4, 0.1], [0.1, 0.5], [0.2, -0.2]])]),
        "tip_displacement": np.hstack([np.array([[1.5, 0.3, -1.0], [0.2, 1.2, 0.9]]) / frequencies, np.zeros((2, r))]),
        "strain": np.zeros((4, 2 * r)),
        "natural_frequencies": frequencies,
        "state_weight": 0.5 * np.eye(2 * r),
        "input_weight": 2.0 * force.T @ np.diag(frequencies**-2.0) @ force,
        "process_noise": np.diag([9.0, 4.0]) * interval,
        "sensor_noise": np.diag((0.02 * full_scale) ** 2) * interval,
        "voltage_limits": np.array([[-500.0, -500.0], [1500.0, 1500.0]]),
        "sensor_full_scale": full_scale,
        "control_interval": interval,
    }
    return Plant(**{**matrices, **changes})


def scalar_plant(a=-40.0, b=2e-3, c=3e-3, e=0.5, q=0.5, r=1e-8, w=4.5e-3, v=2e-12, interval=5e-4):
    """One state, one voltage, one sensor, load in lag alone: Riccati's equation is a quadratic that anyone can solve."""
    return Plant(
        A=np.array([[a]]),
        B=np.array([[b]]),
        C=np.array([[c]]),
        D=np.zeros((1, 1)),
        disturbance_input=np.array([[e, 0.0]]),
        tip_displacement=np.zeros((2, 1)),
        strain=np.zeros((1, 1)),
        natural_frequencies=np.array([1.0]),
        state_weight=np.array([[q]]),
        input_weight=np.array([[r]]),
        process_noise=np.diag([w, 0.0]),
        sensor_noise=np.array([[v]]),
        voltage_limits=np.array([[-1500.0], [1500.0]]),
        sensor_full_scale=np.array([1e-3]),
        control_interval=interval,
    )


@pytest.fixture(name="small_plant", scope="session")
def _small_plant():
    return small_plant


@pytest.fixture(name="scalar_plant", scope="session")
def _scalar_plant():
    return scalar_plant
