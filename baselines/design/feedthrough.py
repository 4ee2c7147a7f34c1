"""Sensors that feel the actuators directly, as part of the plant: what a reading shows of the voltages is a state."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from baselines.design.riccati import Array
from beamenv.plant.plant import SampledPlant


def with_feedthrough(held: SampledPlant, felt: Any = None) -> SampledPlant:
    """The plant with state [x; ζ], ζ = D u of the interval before, of those sensors that have any, so that y = C x + ζ.

    A reading is taken before the next voltage is put on (``beamenv.plant.matrices``), so this is the very plant, without a D. A
    plant whose sensors feel no voltage is returned as it is. ``felt`` (p,) of bools says which sensors may, where
    none does for now.
    """
    felt = np.any(held.D, axis=1) if felt is None else felt
    if not felt.any():
        return held
    (n, m), k, p, q = held.B.shape, held.disturbance_input.shape[1], len(held.C), int(felt.sum())
    own = np.concatenate([np.arange(n), np.arange(n + q, n + q + m + k)])
    cost: Array = np.zeros((n + q + m + k,) * 2)
    cost[np.ix_(own, own)] = held.cost
    return replace(
        held,
        A=block_diag(held.A, np.zeros((q, q))),
        B=np.vstack([held.B, held.D[felt]]),
        C=np.hstack([held.C, np.eye(p)[:, felt]]),
        D=np.zeros((p, m)),
        disturbance_input=np.vstack([held.disturbance_input, np.zeros((q, k))]),
        cost=cost,
    )
