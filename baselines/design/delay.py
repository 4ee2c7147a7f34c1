"""Voltages that come late, as part of the plant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from baselines.design.riccati import Array
from beamenv.configuration import Count, checked
from beamenv.plant.plant import SampledPlant

MOST_LATE = 20
"""Intervals of delay that a law keeps in mind at most: each adds as many numbers to its memory as there are voltages."""


def checked_delay(delay: int) -> int:
    """Control intervals by which voltages come late; ``ValueError`` for what is no whole number from 0 to ``MOST_LATE``."""
    return checked("delay", delay, Count(0, MOST_LATE))


def with_delay(held: SampledPlant, intervals: int) -> SampledPlant:
    """The plant with state [x; u₁ … u_d], the voltages asked for in the last d ``intervals``, the newest first; u_d acts.

    The voltages' own price is charged by halves, when they are asked for and when they act: over a long time it is the same, and
    the regulator's equation keeps a positive weight of what it decides (Franklin, Powell and Workman, Digital Control of Dynamic
    Systems, 1998, section 8.6, for the states).
    """
    if intervals == 0:
        return held
    (n, m), k = held.B.shape, held.disturbance_input.shape[1]
    late = m * intervals
    A = np.zeros((n + late, n + late))
    A[:n, :n], A[:n, n + late - m :] = held.A, held.B
    A[n + m :, n : n + late - m] = np.eye(late - m)
    B = np.zeros((n + late, m))
    B[n : n + m] = np.eye(m)
    acting = np.concatenate([np.arange(n), np.arange(n + late - m, n + late), np.arange(n + late + m, n + late + m + k)])
    cost = np.zeros((n + late + m + k,) * 2)
    cost[np.ix_(acting, acting)] = held.cost
    asked, act = slice(n + late, n + late + m), slice(n + late - m, n + late)
    cost[act, act] -= 0.5 * held.input_weight
    cost[asked, asked] = 0.5 * held.input_weight
    none: Array = np.zeros((late, k))
    return replace(
        held,
        A=A,
        B=B,
        C=np.hstack([held.C, np.zeros((len(held.C), late))]),
        disturbance_input=np.vstack([held.disturbance_input, none]),
        cost=cost,
    )
