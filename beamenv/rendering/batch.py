"""Draws some blades of a batch."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import BladeConfig
from beamenv.rendering.history import Instant
from beamenv.rendering.renderer import BladeRenderer
from beamenv.simulation import Motion

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


class BatchRenderer:
    """A ``BladeRenderer`` for each row of the batch that is in ``configs``; ``full_scale`` (p,): observations of full scale."""

    def __init__(self, configs: Mapping[int, BladeConfig], full_scale: NDArray[Any]) -> None:
        self.renderers = {row: BladeRenderer(config) for row, config in configs.items()}
        self._full_scale = full_scale

    def begin(self, states: Array, motion: Motion, rows: Rows | None = None) -> None:
        """Start the episodes of ``rows``, or of all blades, from the motion of the whole batch."""
        for row, renderer in self.renderers.items():
            if rows is None or row in rows:
                renderer.begin(self._instant(states, motion, row))

    def record(self, states: Array, motion: Motion, begun: Rows | None = None) -> None:
        """Take down what one control interval brought the batch; rows in ``begun`` have begun another episode instead."""
        for row, renderer in self.renderers.items():
            take_down = renderer.begin if begun is not None and row in begun else renderer.record
            take_down(self._instant(states, motion, row))

    def draw(self) -> tuple[NDArray[np.uint8], ...]:
        """Pictures (540, 960, 3), one for each row that is drawn."""
        return tuple(renderer.draw() for renderer in self.renderers.values())

    def _instant(self, states: Array, motion: Motion, row: int) -> Instant:
        reading = motion.observation[row] / self._full_scale
        return Instant(states[row], motion.volts[row], reading, float(motion.cost_increment[row]))
