"""Draws some blades of a batch."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.rendering.choice import renderer_of
from beamenv.rendering.history import Instant
from beamenv.simulation.blades import Blades
from beamenv.simulation.mixed_blades import MixedBlades
from beamenv.simulation.motion import Motion
from beamenv.task import Task

Rows = NDArray[np.int64]


class BatchRenderer:
    """A renderer for each row of the batch in ``tasks``; ``full_scale`` (p,): the observation that is full scale."""

    def __init__(self, tasks: Mapping[int, Task], full_scale: NDArray[Any]) -> None:
        self.renderers = {row: renderer_of(task) for row, task in tasks.items()}
        self._full_scale = full_scale

    def begin(self, blades: Blades | MixedBlades, motion: Motion, rows: Rows | None = None) -> None:
        """Start the episodes of ``rows``, or of all blades, from the motion of the whole batch."""
        for row, instant in self._instants(blades, motion).items():
            if rows is None or row in rows:
                self.renderers[row].begin(instant)

    def record(self, blades: Blades | MixedBlades, motion: Motion, begun: Rows | None = None) -> None:
        """Take down what one control interval brought the batch; rows in ``begun`` have begun another episode instead."""
        for row, instant in self._instants(blades, motion).items():
            begins = begun is not None and row in begun
            (self.renderers[row].begin if begins else self.renderers[row].record)(instant)

    def draw(self) -> tuple[NDArray[np.uint8], ...]:
        """Pictures (540, 960, 3), one for each row that is drawn."""
        return tuple(renderer.draw() for renderer in self.renderers.values())

    def _instants(self, blades: Blades | MixedBlades, motion: Motion) -> dict[int, Instant]:
        states, plants, speeds = blades.state, blades.index, blades.speed
        return {
            row: Instant(
                state=states[row],
                plant=int(plants[row]),
                speed=float(speeds[row]),
                tip_displacement=motion.tip_displacement[row],
                volts=motion.volts[row],
                reading=motion.observation[row] / self._full_scale,
                cost_increment=float(motion.cost_increment[row]),
            )
            for row in self.renderers
        }
