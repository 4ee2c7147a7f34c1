"""Riccati equations of control and filtering, continuous and sampled: algorithms on matrices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve, solve_continuous_are, solve_discrete_are

Array = NDArray[np.float64]


def regulator(A: Array, B: Array, state_weight: Array, input_weight: Array) -> tuple[Array, Array]:
    """Continuous regulator: P (n, n) and gain K (m, n) of u = −K x (thesis Eqs. 5.10, 5.11).

    PA + AᵀP + Q − PBR⁻¹BᵀP = 0, K = R⁻¹BᵀP.
    """
    unit = _unit_diagonal(input_weight)  # J/V² is tiny: with each input's own weight as unit the pencil is well scaled
    B_unit, R_unit = B * unit, input_weight * np.outer(unit, unit)
    P = solve_continuous_are(A, B_unit, state_weight, R_unit)
    return P, unit[:, None] * solve(R_unit, B_unit.T @ P, assume_a="pos")


def kalman_filter(A: Array, C: Array, process_noise: Array, sensor_noise: Array) -> tuple[Array, Array]:
    """Continuous filter: error covariance S (n, n) and gain L (n, p) of x̂̇ = A x̂ + B u + L (y − C x̂).

    AS + SAᵀ + W − SCᵀV⁻¹CS = 0, L = SCᵀV⁻¹ (thesis Eqs. 5.20, 5.21 with the transpose that 5.21 lacks): the regulator's dual.
    """
    S, gain = regulator(A.T, C.T, process_noise, sensor_noise)
    return S, gain.T


def sampled_regulator(
    A: Array, B: Array, state_weight: Array, input_weight: Array, cross_weight: Array | None = None
) -> tuple[Array, Array]:
    """Sampled regulator: P (n, n) and gain K (m, n) of u = −K x, least Σ xᵀQx + 2xᵀNu + uᵀRu.

    P = AᵀPA + Q − (AᵀPB + N) K, K = (R + BᵀPB)⁻¹ (BᵀPA + Nᵀ).
    """
    unit = _unit_diagonal(input_weight)
    B_unit, R_unit = B * unit, input_weight * np.outer(unit, unit)
    N_unit = np.zeros_like(B) if cross_weight is None else cross_weight * unit
    P = solve_discrete_are(A, B_unit, state_weight, R_unit, s=N_unit)
    return P, unit[:, None] * solve(R_unit + B_unit.T @ P @ B_unit, B_unit.T @ P @ A + N_unit.T, assume_a="pos")


def sampled_kalman_filter(A: Array, C: Array, process_noise: Array, sensor_noise: Array) -> tuple[Array, Array]:
    """Sampled filter: covariance S (n, n) of the *predicted* state and the *filter* gain L (n, p), x̂ ← x̂ + L (y − C x̂).

    S = A (S − L C S) Aᵀ + W, L = SCᵀ(CSCᵀ + V)⁻¹. The predictor's gain, which ``control.dlqe`` returns, is A L.
    """
    S, _ = sampled_regulator(A.T, C.T, process_noise, sensor_noise)  # its gain is (A L)ᵀ: dividing A out would cost digits
    unit = _unit_diagonal(sensor_noise)
    C_unit = C * unit[:, None]
    innovation = C_unit @ S @ C_unit.T + sensor_noise * np.outer(unit, unit)
    return S, solve(innovation, C_unit @ S, assume_a="pos").T * unit


def _unit_diagonal(weight: Array) -> Array:
    """Units (m,) in which a positive weight has a unit diagonal."""
    return 1.0 / np.sqrt(np.diag(weight))
