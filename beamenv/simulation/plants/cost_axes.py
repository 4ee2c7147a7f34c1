"""Coordinates in which a step is cheap: those axes of the energy in which the cost of an interval is diagonal too.

½ xᵀx is the energy of the blade in any orthonormal axes x' = Uᵀx of its 2r states, and the cost of an interval has one symmetric
(2r, 2r) block P of its own, ∫ xᵀQx dt: with the eigenvectors U of P both are sums of squares. Nothing is left out; what the cost
then still needs of the product are the columns of voltages, loads and amplifiers.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed
from beamenv.plant.plant import Plant
from beamenv.simulation.kernel import Operators

Array = NDArray[np.float64]

GONE = 1e-10
"""What is left of an amplifier's lag after an interval counts as nothing below this: at the default 6·10⁻¹¹."""


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


def output_states(plant: Plant) -> slice | None:
    """The equally spaced states, after the blade's, that the outputs are, one each; None where outputs are others."""
    (p, n), places = plant.C.shape, plant.C.argmax(axis=1)
    every = places[1] - places[0] if p > 1 else 1
    if every < 1 or places[0] < plant.blade_states or plant.D.any():
        return None
    shown = slice(int(places[0]), int(places[0] + p * every), int(every))
    return shown if np.array_equal(plant.C, np.eye(n)[shown]) else None


def amplifier_decay(plant: Plant) -> float | None:
    """e^(−aΔt) where the last m states are voltages v̇ = a (u − v), one for each of the plant's; None where they are not.

    Less than ``GONE`` is 0.
    """
    m, n = plant.B.shape[1], len(plant.A)
    rows, pole = plant.A[-m:], plant.B[-1, -1]
    lag = pole > 0.0 and n - m >= plant.blade_states and not plant.disturbance_input[-m:].any()
    if (
        not lag
        or not np.allclose(rows, -pole * np.eye(m, n, n - m), 1e-12, 0.0)
        or not np.allclose(plant.B[-m:], pole * np.eye(m), 1e-12, 0.0)
    ):
        return None
    decay = float(np.exp(-pole * plant.control_interval))
    return decay if decay > GONE else 0.0


def in_axes(operators: Operators, axes: Array, following: Array, plant: Plant) -> Operators:
    """Operators of ``Operators.from_plant`` from states in ``axes`` (…, n, n) to states in the ``following`` axes.

    ``plant``, with normalised voltages and currents, says which states are what.
    """
    n, p, q, b = operators.states, len(plant.C), operators.displaced, plant.blade_states
    shown, decay = output_states(plant), amplifier_decay(plant)
    reads = None if shown is None or shown.step > 1 else shown
    lagging = 0 if decay is None else plant.B.shape[1]
    fused, size, crossing = operators.fused, operators.fused.shape[-2], b + without_cost(plant)
    whole = np.broadcast_to(np.eye(size), (*fused.shape[:-2], size, size)).copy()
    whole[..., :n, :n] = axes
    moved = whole @ fused
    cost = moved[..., n + p + q :] @ whole.swapaxes(-1, -2)
    crossed = cost[..., crossing:].copy()
    crossed[..., :b, :] *= 2.0
    state = moved[..., :n] @ following.swapaxes(-1, -2)
    parts = [state[..., : n - lagging], crossed, moved[..., n + p : n + p + q], moved[..., n : n + (p if reads is None else 0)]]
    costs = n - lagging
    tips = costs + crossed.shape[-1]
    return Operators(
        fused=sealed(np.ascontiguousarray(np.concatenate(parts, axis=-1))),
        weights=sealed(np.diagonal(cost[..., :b, :b], axis1=-2, axis2=-1).copy()),
        states=n,
        reads=slice(tips + q, tips + q + p) if reads is None else reads,
        tips=tips,
        displaced=q,
        costs=costs,
        crossing=crossing,
        lagging=lagging,
        decay=decay or 0.0,
    )


def lean(operators: Operators, plant: Plant) -> Operators:
    """Operators of ``in_axes`` without columns for outputs that are states, neighbours or not.

    BLAS rounds what is left otherwise, for it goes through columns several at a time: NumPy's 64 bits, the reference, keep them.
    """
    shown, beyond = output_states(plant), operators.tips + operators.displaced
    if shown is None or operators.reads.start < beyond:
        return operators
    return replace(operators, fused=operators.fused[..., :beyond], reads=shown)
