"""Coordinates in which a step is cheap: those axes of the energy in which the cost of an interval is diagonal too.

½ xᵀx is the energy of the blade in any orthonormal axes x' = Uᵀx of its 2r states, and the cost of an interval has one symmetric
(2r, 2r) block P of its own, ∫ xᵀQx dt: with the eigenvectors U of P both are sums of squares. Nothing is left out; what the cost
then still needs of the product are the columns of voltages, loads and amplifiers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.plant.plant import Plant
from beamenv.plant.read_only import sealed
from beamenv.simulation.kernel import Operators

Array = NDArray[np.float64]


def cost_axes(cost: Array, states: int, blade_states: int) -> Array:
    """T (…, n, n), orthogonal, of the coordinates x' = T x, from costs (…, s, s): Uᵀ for the blade's states, which come first."""
    axes = np.broadcast_to(np.eye(states), (*cost.shape[:-2], states, states)).copy()
    _, vectors = np.linalg.eigh(cost[..., :blade_states, :blade_states])
    axes[..., :blade_states, :blade_states] = vectors.swapaxes(-1, -2)
    return axes


def without_cost(plant: Plant) -> int:
    """How many states that follow the blade's neither have a cost nor move what has one: filters."""
    matters = np.any(plant.state_weight != 0.0, axis=1)
    while True:
        moved = matters | np.any(plant.A[matters] != 0.0, axis=0)
        if np.array_equal(moved, matters):
            return int(np.argmax(np.append(matters[plant.blade_states :], True)))
        matters = moved


def output_states(plant: Plant) -> int | None:
    """The first of neighbouring states that the outputs are, one each; None where outputs are others."""
    (p, n), b = plant.C.shape, plant.blade_states
    if np.any(plant.D):
        return None
    return next((k for k in range(b, n - p + 1) if np.array_equal(plant.C, np.eye(p, n, k))), None)


def in_axes(operators: Operators, axes: Array, following: Array, blade_states: int, costless: int, reads: int | None) -> Operators:
    """Operators of ``Operators.from_plant`` from states in ``axes`` (…, n, n) to states in the ``following`` axes.

    ``blade_states`` of them are the blade's, so many after them are ``costless``, and outputs are the states from ``reads`` on, if
    any.
    """
    n, p, b = operators.states, operators.outputs, blade_states
    fused, size, crossing = operators.fused, operators.fused.shape[-2], b + costless
    whole = np.broadcast_to(np.eye(size), (*fused.shape[:-2], size, size)).copy()
    whole[..., :n, :n] = axes
    moved = whole @ fused
    cost = moved[..., n + p + 2 :] @ whole.swapaxes(-1, -2)
    crossed = cost[..., crossing:].copy()
    crossed[..., :b, :] *= 2.0
    parts = [moved[..., :n] @ following.swapaxes(-1, -2), moved[..., n + p : n + p + 2], crossed]
    if reads is None:
        parts.insert(1, moved[..., n : n + p])
    return Operators(
        fused=sealed(np.ascontiguousarray(np.concatenate(parts, axis=-1))),
        weights=sealed(np.diagonal(cost[..., :b, :b], axis1=-2, axis2=-1).copy()),
        states=n,
        outputs=p,
        reads=n if reads is None else reads,
        tips=n if reads is not None else n + p,
        crossing=crossing,
    )
