"""Every layout of one or two patches on a fine grid, then SQP from the best: the global optimum to judge the others by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.placement.placement import Recorder
from baselines.placement.sqp import SequentialQuadratic

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Grid:
    """An exhaustive search."""

    points: tuple[int, int] = (401, 121)
    """Positions of a single patch, and of each of two."""
    polished: int = 4
    """The best local minima of the grid, from each of which SQP goes on."""

    def run(self, recorder: Recorder, start: Array, generator: np.random.Generator) -> None:
        """Search; ``ValueError`` for more than two patches. Neither start nor generator matters."""
        layouts, shape = self._layouts(recorder)
        costs = np.full(len(layouts), np.inf)
        for first in range(0, len(layouts), 600):
            costs[first : first + 600] = recorder.costs(layouts[first : first + 600])
            recorder.note(0.9 * first / len(layouts))
        for index in local_minima(costs, shape)[: self.polished]:
            SequentialQuadratic().descend(recorder, layouts[index])
        recorder.note(1.0)

    def _layouts(self, recorder: Recorder) -> tuple[Array, tuple[int, ...]]:
        """(N, count) feasible layouts on a grid of the slack, and the grid's shape."""
        bounds = recorder.problem.bounds
        if bounds.count > len(self.points):
            raise ValueError(f"method = 'grid' serves one or two patches, not {bounds.count}: take another method.")
        axis = bounds.low + np.linspace(0.0, bounds.slack, self.points[bounds.count - 1])
        grid = np.stack(np.meshgrid(*[axis] * bounds.count, indexing="ij"), axis=-1)
        ordered = np.sort(grid.reshape(-1, bounds.count), axis=1)  # each layout of two comes twice; the second is repaired away
        return ordered + bounds.length * np.arange(bounds.count), grid.shape[:-1]


def local_minima(costs: Array, shape: tuple[int, ...]) -> NDArray[np.intp]:
    """Indices of grid points no dearer than their neighbours, cheapest first."""
    table = np.pad(costs.reshape(shape), 1, constant_values=np.inf)
    centre = tuple(slice(1, -1) for _ in shape)
    least = np.ones(shape, dtype=bool)
    for axis in range(len(shape)):
        for shift in (-1, 1):
            least &= table[centre] <= np.roll(table, shift, axis=axis)[centre]
    found = np.flatnonzero(least)
    return found[np.argsort(costs[found], kind="stable")]
