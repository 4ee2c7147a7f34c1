"""Laws of lower order that do nearly the same on their plant: balanced truncation within the closed loop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

from baselines.design.linear import LinearController, linear
from baselines.design.loop import closed_loop, sampled, spectral_radius
from baselines.design.riccati import Array
from baselines.design.verification import verified
from beamenv.configuration import Count, checked
from beamenv.plant.plant import Plant, SampledPlant


def reduced(plant: Plant | SampledPlant, law: LinearController, order: int, *, verify: bool = True) -> LinearController:
    """The law with ``order`` numbers in its memory instead of ``law.order``.

    In the closed loop under the plant's white loads and sensor noise the memory has a covariance, and each direction of it a say in
    the cost that follows. Directions in which the product of the two is least are left out (Wortelboer and Bosgra 1994; what
    Moore's balanced truncation is to a plant by itself). The result is ``verified`` on ``plant`` unless ``verify=False``. Raises
    ``ValueError`` for an order that is not below the law's, for a law whose loop is unstable, and where the loop of the result is.
    """
    order = checked("order", order, Count(1, linear(law).order - 1))
    return verified(truncations(plant, law)(order), plant, instead="a larger order", verify=verify)


def truncations(plant: Plant | SampledPlant, law: LinearController) -> Callable[[int], LinearController]:
    """The law of each order, from one balancing; it may be unstable."""
    basis, dual = balanced(sampled(plant, law), law)

    def of(order: int) -> LinearController:
        onto, back = basis[:, :order], dual[:order]
        return replace(
            law,
            transition=back @ law.transition @ onto,
            measurement_input=back @ law.measurement_input,
            voltage_input=back @ law.voltage_input,
            state_gain=law.state_gain @ onto,
        )

    return of


def balanced(held: SampledPlant, law: LinearController) -> tuple[Array, Array]:
    """Basis and dual basis (s, k), (k, s) of the memory, the most important direction first; k of them are not lost in rounding.

    The memory is about basis[:, :r] times that of ``truncations(held, law)(r)``. Raises ``ValueError`` as ``reduced`` does.
    """
    transition, noise_input, state_map, _, covariance = closed_loop(held, law)
    if spectral_radius(transition) >= 1.0:
        raise ValueError(f"law = {law.name} is unstable on the plant, and cannot be reduced there.")
    n = len(held.A)
    spread = solve_discrete_lyapunov(transition, noise_input @ covariance @ noise_input.T, method="bilinear")[n:, n:]
    cost = state_map.T @ held.cost @ state_map
    say = solve_discrete_lyapunov(transition.T, 0.5 * (cost + cost.T), method="bilinear")[n:, n:]
    reached, felt = _root(spread), _root(say)
    left, values, right = np.linalg.svd(felt.T @ reached)
    count = int(np.count_nonzero(values > values[0] * np.finfo(float).eps * len(values)))
    scale = 1.0 / np.sqrt(values[:count])
    return reached @ right[:count].T * scale, (left[:, :count] * scale).T @ felt.T


def _root(matrix: Array) -> Array:
    values, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))
