"""What a layout buys: poles of the regulator, or of the filter, that the trace belongs to."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.placement.cost.problem import PlacementProblem
from baselines.placement.cost.riccati import solve_riccati


def design_poles(problem: PlacementProblem, positions: ArrayLike) -> NDArray[np.complex128]:
    """Poles (2r,), rad/s, of A − BK (actuators) or A − LC (sensors) with patches at ``positions`` (count,), slowest first."""
    equation = problem.equation(problem.at(positions))
    A, G, _ = (each[0] for each in equation)
    return _slowest_first(np.linalg.eigvals(A - G @ solve_riccati(*equation)[0]))


def open_loop_poles(problem: PlacementProblem, positions: ArrayLike) -> NDArray[np.complex128]:
    """Poles (2r,), rad/s, of the blade left alone, slowest first."""
    return _slowest_first(np.linalg.eigvals(problem.at(positions).dynamics[0]))


def _slowest_first(poles: NDArray[np.complex128]) -> NDArray[np.complex128]:
    return np.asarray(poles[np.lexsort((poles.imag, np.abs(poles)))], dtype=np.complex128)
