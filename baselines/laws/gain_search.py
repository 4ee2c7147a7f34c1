"""Gains of least cost among those whose loop is stable."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from baselines.design.controller import Array

_SMALLER = 10.0 ** -np.arange(1.0, 9.0)
"""Of the smallest gain tried, where none of those tried is stable: as gains go to zero the loop is the blade's own."""


def least_cost_gains(cost: Callable[[Array], float], common: NDArray[np.float64], count: int, law: str, **options: float) -> Array:
    """(count,): first the best of the ``common`` gains, or the largest below them that is stable, then each for itself from there.

    ``cost`` (J/s) of (count,) gains is infinite where the loop is unstable. Nelder and Mead's simplex, with ``options`` of SciPy's.
    Raises ValueError, with the name of the ``law``, for a plant that no gain leaves stable.
    """
    start = np.full(count, min(common, key=lambda gain: cost(np.full(count, gain))))
    if not np.isfinite(cost(start)):
        smaller = (np.full(count, common.min() * share) for share in _SMALLER)
        stable = next((each for each in smaller if np.isfinite(cost(each))), None)
        if stable is None:
            raise ValueError(
                f"plant is unstable under {law} of any gain tried, down to {common.min() * _SMALLER[-1]:.1e} of its unit: allowed "
                "are plants that are stable by themselves, with damping in every mode, or a gain of your own and verify=False."
            )
        start = stable
    simplex = np.vstack([start, start + start[0] * np.eye(count)])
    settings = {"initial_simplex": simplex, "fatol": 1e-6 * cost(start), **options}
    return np.asarray(minimize(cost, start, method="Nelder-Mead", options=settings).x)
