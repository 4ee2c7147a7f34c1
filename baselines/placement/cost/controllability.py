"""Modes that a layout cannot move, or cannot sense."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.placement.cost.problem import PlacementProblem
from beamenv.blade.build import build_beam
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Instance, checked

Array = NDArray[np.float64]

NO_REACH = 1e-6
"""Share of the best-reached mode below which a mode is beyond reach: round-off leaves 1e-12, the weakest coupling seen is 2e-4."""


def reach(problem: PlacementProblem, positions: ArrayLike) -> Array:
    """How well one layout (count,) drives (or reads) each of the r modes of the damped blade, the best being one (r,).

    By Popov, Belevitch and Hautus: |vᴴB| of each unit left eigenvector v of A, the columns of B each of unit length (sensors: Cᵀ
    and Aᵀ), over both eigenvectors of a mode. Raises ``ValueError`` for positions that are not feasible.
    """
    checked("problem", problem, Instance(PlacementProblem))
    blade = problem.at(positions)
    A = blade.dynamics[0]
    if problem.side == "actuators":
        through, matrix = blade.input[0], A.T
    else:
        through, matrix = blade.output[0].T, A
    values, vectors = np.linalg.eig(matrix)
    upper = values.imag >= 0.0
    ordered = np.argsort(np.abs(values[upper]))
    met = np.linalg.norm(vectors[:, upper][:, ordered].T @ through, axis=1)
    return np.asarray(met / max(met.max(), np.finfo(float).tiny))


def check_reach(problem: PlacementProblem, positions: ArrayLike) -> None:
    """``ValueError`` naming the first mode that a layout cannot move (or sense)."""
    checked("problem", problem, Instance(PlacementProblem))
    shares = reach(problem, positions)
    if shares.min() >= NO_REACH:
        return
    mode = int(np.flatnonzero(shares < NO_REACH)[0])
    config = problem.configuration(positions)
    frequency = problem.at(positions).natural_frequencies[0, mode]
    verb = "move" if problem.side == "actuators" else "sense"
    given = ", ".join(f"{position:.4g}" for position in np.asarray(positions))
    raise ValueError(
        f"{problem.side} = ({given}) m cannot {verb} mode {mode + 1} ({families(config)[mode]}, {frequency:.4g} rad/s): "
        f"choose positions, a lay-up or a pretwist that couple it to the patches, or leave it alone by leave_unreached."
    )


def families(config: BladeConfig) -> tuple[str, ...]:
    """Of each mode lag, flap, extension or twist: where most of its kinetic energy is."""
    return tuple(build_beam(config).modes(config.speed, config.modes, gyroscopic=False).families)
