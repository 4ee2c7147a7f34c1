"""The two Riccati equations of placement, AᵀX + XA + Q − XGX = 0, and their derivatives by patch positions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_continuous_lyapunov

from baselines.placement.model.reduced_slopes import ReducedSlopes
from beamenv.plant.reduction import ReducedBlades

Array = NDArray[np.float64]


class Equation(NamedTuple):
    """A, G, Q of N equations, or their derivatives by p positions; (N, n, n) or (1, n, n) for all."""

    A: Array
    G: Array
    Q: Array


def regulator_equation(blades: ReducedBlades) -> Equation:
    """PA + AᵀP + ½I − PBR⁻¹BᵀP = 0 (thesis Eq. 5.11): Q is the vibration energy."""
    A, B = blades.dynamics, blades.input
    return Equation(A, B @ np.linalg.solve(blades.input_weight, transposed(B)), 0.5 * np.eye(A.shape[-1])[None])


def regulator_slopes(blades: ReducedBlades, slopes: ReducedSlopes) -> Equation:
    """Derivatives of one blade's regulator equation."""
    gain = np.linalg.solve(blades.input_weight[0], blades.input[0].T)
    half = slopes.input @ gain
    return Equation(slopes.dynamics, half + transposed(half) - gain.T @ slopes.input_weight @ gain, np.zeros((1, 1, 1)))


def filter_equation(blades: ReducedBlades, load_noise: Array, sensor_noise: float) -> Equation:
    """AS + SAᵀ + EWEᵀ − SCᵀV⁻¹CS = 0 (thesis Eq. 5.21 with the transpose it lacks): ``load_noise`` W (2, 2), ``sensor_noise`` V."""
    E, C = blades.disturbance_input, blades.output
    return Equation(transposed(blades.dynamics), transposed(C) @ C / sensor_noise, E @ load_noise @ transposed(E))


def filter_slopes(blades: ReducedBlades, slopes: ReducedSlopes, load_noise: Array, sensor_noise: float) -> Equation:
    """Derivatives of one blade's filter equation."""
    information = transposed(slopes.output) @ blades.output[0] / sensor_noise
    loads = slopes.disturbance_input @ load_noise @ blades.disturbance_input[0].T
    return Equation(transposed(slopes.dynamics), information + transposed(information), loads + transposed(loads))


def trace_slopes(equation: Equation, slopes: Equation, solution: Array, weight: Array | None = None) -> Array:
    """Derivatives of tr(X N) (p,) of one equation with solution X (n, n), by its adjoint; N is ``weight`` (n, n), or the identity.

    With A_c = A − GX and A_c Λ + Λ A_cᵀ + N = 0: d tr(X N) = tr(Λ (X dA + dAᵀX + dQ − X dG X)).
    """
    weight = np.eye(len(solution)) if weight is None else weight
    adjoint = solve_continuous_lyapunov(equation.A[0] - equation.G[0] @ solution, -weight)
    change = 2.0 * solution @ slopes.A + slopes.Q - solution @ slopes.G @ solution
    return np.asarray(np.einsum("ij,pji->p", adjoint, change))


def transposed(matrices: Array) -> Array:
    """Over the last two axes."""
    return matrices.swapaxes(-1, -2)
