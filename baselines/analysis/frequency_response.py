"""Frequency responses of sampled systems, and the largest gain from a plant's noise to its cost in a closed loop."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import schur
from scipy.optimize import minimize_scalar

from baselines.design.controller import Array
from baselines.design.linear import LinearController, linear
from baselines.design.loop import closed_loop, sampled, spectral_radius
from beamenv.plant.plant import Plant, SampledPlant

Complex = NDArray[np.complex128]

_LARGE = 40
"""States from which on triangular form pays."""

_AT_ONCE = 512
"""Angles, so that memory stays small."""


def frequency_response(A: Array, B: Array, C: Array, D: Array, angles: ArrayLike) -> Complex:
    """C (zI − A)⁻¹ B + D at z = exp(iθ): (k, p, m) for k ``angles`` θ in rad a sample.

    With many more angles than states A is brought to triangular form first, A = U T Uᴴ, and each angle takes a substitution.
    """
    z = np.exp(1j * np.atleast_1d(np.asarray(angles, dtype=np.float64)))
    if len(A) < _LARGE or len(z) < len(A):
        resolvent = np.linalg.solve(z[:, None, None] * np.eye(len(A)) - A, np.broadcast_to(B.astype(complex), (len(z), *B.shape)))
        return np.asarray(C @ resolvent + D)
    T, U = schur(A, output="complex")
    inputs, outputs = U.conj().T @ B, C @ U
    parts = np.array_split(z, -(-len(z) // _AT_ONCE))
    return np.concatenate([outputs @ _substituted(T, inputs, part) + D for part in parts])


def _substituted(T: Complex, inputs: Complex, z: Complex) -> Complex:
    """(zI − T)⁻¹ inputs (k, n, m) for an upper triangular T (n, n), from the last row upwards."""
    (n, m), k = inputs.shape, len(z)
    found = np.empty((n, k * m), dtype=complex)
    for row in reversed(range(n)):
        known = T[row, row + 1 :] @ found[row + 1 :]
        found[row] = ((inputs[row] + known.reshape(k, m)) / (z - T[row, row])[:, None]).ravel()
    return np.asarray(found.reshape(n, k, m).transpose(1, 0, 2))


def resonant_angles(*systems: Array) -> Array:
    """Angles from 0 to π in rad a sample: evenly spaced, and about each pole of the transition matrices as dense as it is light."""
    poles = np.concatenate([np.linalg.eigvals(A) for A in systems])
    poles = poles[np.abs(poles) > 1e-6]
    around = np.abs(np.angle(poles))[:, None] + np.abs(np.log(np.abs(poles)))[:, None] * np.tan(np.linspace(-1.5, 1.5, 25))
    return np.unique(np.clip(np.concatenate([np.linspace(0.0, np.pi, 400), around.ravel()]), 0.0, np.pi))


def highest(function: Callable[[Array], Array], angles: Array) -> tuple[float, float]:
    """The largest value of a function of angles over a grid, refined between its neighbours, and the angle where it is."""
    values = function(angles)
    top = int(values.argmax())
    low, high = angles[max(top - 1, 0)], angles[min(top + 1, len(angles) - 1)]
    found = minimize_scalar(lambda angle: -float(function(np.array([angle]))[0]), bounds=(low, high), method="bounded")
    return max((float(-found.fun), float(found.x)), (float(values[top]), float(angles[top])))


def cost_response(plant: Plant, controller: LinearController, frequencies: ArrayLike) -> Complex:
    """From the noise [d; v], in units of its standard deviations, to z with |z|² the cost of an interval (J s): (k, n+m+2, 2+p).

    ``frequencies`` (k,) in rad/s, voltages unlimited.
    """
    angles = np.atleast_1d(np.asarray(frequencies, dtype=np.float64)) * plant.control_interval
    return frequency_response(*_noise_to_cost(plant, controller), angles)


def h_infinity_norm(plant: Plant | SampledPlant, controller: LinearController) -> float:
    """The largest gain, √(J s), of ``cost_response`` over all frequencies. Noise n with Σ|n|² = 1 costs at most its square, J s.

    Infinite when the loop is unstable. Raises ValueError for a controller that is not linear.
    """
    system = _noise_to_cost(plant, controller)
    if spectral_radius(system[0]) >= 1.0:
        return float("inf")

    def gain(angles: Array) -> Array:
        response = frequency_response(*system, angles)
        squared = np.linalg.eigvalsh(np.conj(response.transpose(0, 2, 1)) @ response)  # of few inputs, and of many outputs
        return np.asarray(np.sqrt(np.maximum(squared[:, -1], 0.0)))

    return highest(gain, resonant_angles(system[0]))[0]


def _noise_to_cost(plant: Plant | SampledPlant, controller: LinearController) -> tuple[Array, Array, Array, Array]:
    law = linear(controller)
    held = sampled(plant, law)
    transition, noise_input, state_map, noise_map, covariance = closed_loop(held, law)
    deviation, weight = square_root(covariance), square_root(held.cost)
    return transition, noise_input @ deviation, weight.T @ state_map, weight.T @ noise_map @ deviation


def square_root(matrix: Array) -> Array:
    """Factor F with F Fᵀ = ``matrix`` (k, k), which is symmetric and not negative; each row in its own unit, whatever the units."""
    unit = np.sqrt(np.where(np.diag(matrix) > 0.0, np.diag(matrix), 1.0))
    values, vectors = np.linalg.eigh(matrix / np.outer(unit, unit))
    return np.asarray(unit[:, None] * vectors * np.sqrt(np.maximum(values, 0.0)))
