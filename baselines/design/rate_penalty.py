"""A price on changes of the voltage: it keeps a law off frequencies at which little is gained and much may be unknown."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from baselines.design.riccati import Array
from beamenv.plant.plant import SampledPlant


def with_rate_penalty(held: SampledPlant, weight: float) -> SampledPlant:
    """The plant with state [x; u₋], u₋ (m,) the voltages of the interval before, and a price on u − u₋.

    To the cost of each interval comes weight (u − u₋)ᵀ diag(R) (u − u₋), R being the plant's own weight of effort in an interval.
    """
    (n, m), k = held.B.shape, held.disturbance_input.shape[1]
    price = weight * np.diag(np.diagonal(held.input_weight))
    cost = np.zeros((n + 2 * m + k,) * 2)
    own = np.concatenate([np.arange(n), np.arange(n + m, n + 2 * m + k)])
    cost[np.ix_(own, own)] = held.cost
    before, now = slice(n, n + m), slice(n + m, n + 2 * m)
    cost[before, before] += price
    cost[now, now] += price
    cost[before, now] -= price
    cost[now, before] -= price
    none: Array = np.zeros((m, m))
    return replace(
        held,
        A=np.block([[held.A, np.zeros((n, m))], [np.zeros((m, n)), none]]),
        B=np.vstack([held.B, np.eye(m)]),
        C=np.hstack([held.C, np.zeros((len(held.C), m))]),
        disturbance_input=np.vstack([held.disturbance_input, np.zeros((m, k))]),
        cost=cost,
    )
