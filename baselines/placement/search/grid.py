"""Every layout of one or two patches on a fine grid, then SQP from the best: the global optimum to judge the others by."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from baselines.placement.search.placement import Recorder
from baselines.placement.search.sqp import SequentialQuadratic
from beamenv.configuration import Count, Numbers, Whole, configuration

Array = NDArray[np.float64]

CHUNK = 600
"""Layouts between two reports of progress."""


@configuration("Grid")
class Grid:
    """An exhaustive search."""

    points: Annotated[tuple[int, ...], Numbers(Count(2, 10_000), 2, 2)] = (401, 121)
    """Positions of a single patch, and of each of two."""
    polished: Whole = 4
    """The best local minima of the grid, from each of which SQP continues."""

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Search; ``ValueError`` for more than two patches. Neither start nor generator matters."""
        layouts, shape, where = self._layouts(recorder)
        table = np.full(int(np.prod(shape)), np.inf)
        for first in range(0, len(layouts), CHUNK):
            table[where[first : first + CHUNK]] = recorder.costs(layouts[first : first + CHUNK])
            recorder.note(0.9 * first / len(layouts))
        at = np.full(table.shape, -1)
        at[where] = np.arange(len(layouts))
        for index in local_minima(table.reshape(shape))[: self.polished]:
            SequentialQuadratic().descend(recorder, layouts[at[index]])
        recorder.note(1.0)

    def _layouts(self, recorder: Recorder) -> tuple[Array, tuple[int, ...], NDArray[np.intp]]:
        """(N, count) ordered layouts on a grid of the slack, the grid's shape, and the place (N,) of each in it."""
        bounds = recorder.problem.bounds
        if bounds.count > len(self.points):
            raise ValueError(f"method = 'grid' serves one or two patches, not {bounds.count}: take another method.")
        axis = bounds.low + np.linspace(0.0, bounds.slack, self.points[bounds.count - 1])
        grid = np.stack(np.meshgrid(*[axis] * bounds.count, indexing="ij"), axis=-1)
        flat = grid.reshape(-1, bounds.count)
        where = np.flatnonzero(np.all(np.diff(flat, axis=1) >= 0.0, axis=1))
        return flat[where] + bounds.length * np.arange(bounds.count), grid.shape[:-1], where


def local_minima(costs: Array) -> NDArray[np.intp]:
    """Flat indices of finite grid points no dearer than their neighbours, cheapest first."""
    table = np.pad(costs, 1, constant_values=np.inf)
    centre = (slice(1, -1),) * costs.ndim
    least = np.isfinite(costs)
    for axis in range(costs.ndim):
        for shift in (-1, 1):
            least &= table[centre] <= np.roll(table, shift, axis=axis)[centre]
    found = np.flatnonzero(least)
    return found[np.argsort(costs.ravel()[found], kind="stable")]
