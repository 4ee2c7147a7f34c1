"""What the regulator and the filter together cost in the long run under white loads and noise: the stationary cost of LQG."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from baselines.placement.cost.riccati import solve_riccati
from baselines.placement.model.equations import (
    Equation,
    filter_equation,
    filter_slopes,
    regulator_equation,
    regulator_slopes,
    trace_slopes,
)
from baselines.placement.model.reduced_slopes import ReducedSlopes
from beamenv.plant.reduction import ReducedBlades

Array = NDArray[np.float64]


class Loop(NamedTuple):
    """Both equations of N closed loops, or their derivatives."""

    regulator: Equation
    filter: Equation

    @classmethod
    def of(cls, blades: ReducedBlades, load_noise: Array, sensor_noise: float) -> Loop:
        """Of reduced blades under loads of covariance W (2, 2), (N/m)² s, read with noise V, A² s."""
        return cls(regulator_equation(blades), filter_equation(blades, load_noise, sensor_noise))

    @classmethod
    def slopes(cls, blades: ReducedBlades, slopes: ReducedSlopes, load_noise: Array, sensor_noise: float) -> Loop:
        """Derivatives of one blade's."""
        return cls(regulator_slopes(blades, slopes), filter_slopes(blades, slopes, load_noise, sensor_noise))


def loop_cost(loop: Loop) -> Array:
    """Mean of ½xᵀx + uᵀRu (N,), J, of LQG: tr(P W̄) + tr(S KᵀRK), with W̄ = EWEᵀ and KᵀRK = PGP.

    The first is what it costs with the state known, the second what not knowing it adds (Kwakernaak and Sivan, Linear Optimal
    Control Systems, 1972, Theorem 5.4).
    """
    P, S = solve_riccati(*loop.regulator), solve_riccati(*loop.filter)
    return np.asarray(np.sum(P * loop.filter.Q, axis=(1, 2)) + np.sum(S * (P @ loop.regulator.G @ P), axis=(1, 2)))


def loop_cost_and_slopes(loop: Loop, slopes: Loop) -> tuple[float, Array]:
    """The cost of one loop and its derivatives (p,): both equations' adjoints, weighed by what else depends on P and S."""
    P, S = solve_riccati(*loop.regulator)[0], solve_riccati(*loop.filter)[0]
    G, loads = loop.regulator.G[0], loop.filter.Q[0]
    effort, shared = P @ G @ P, S @ P @ G
    by_regulator = trace_slopes(loop.regulator, slopes.regulator, P, loads + shared + shared.T)
    by_filter = trace_slopes(loop.filter, slopes.filter, S, effort)
    at_once = np.einsum("ij,pij->p", P, slopes.filter.Q) + np.einsum("ij,pij->p", P @ S @ P, slopes.regulator.G)
    return float(np.sum(P * loads) + np.sum(S * effort)), by_regulator + by_filter + at_once
