"""A model of two modes that tests share, with a voltage and two sensors."""

import control
import numpy as np
from scipy.linalg import block_diag


def oscillator(omega, damping):
    return np.array([[0.0, omega], [-omega, -2.0 * damping * omega]])


A = block_diag(oscillator(30.0, 0.01), oscillator(95.0, 0.02))
B = np.array([[0.0], [1.0], [0.0], [0.7]])
C = np.array([[0.0, 1.0, 0.0, 0.9], [1.0, 0.0, -0.5, 0.0]])
SYSTEM = control.ss(A, B, C, np.zeros((2, 1)))
