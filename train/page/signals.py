"""What is drawn of an episode above the voltages: displacements, or, of a model that tells none, what the sensors show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from train.page.recording import RecordedEpisode

Array = NDArray[np.float64]

TIP = ("tip displacement, lag", "tip displacement, flap")


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """One signal of every recording."""

    title: str
    unit: str
    """Empty where none is known."""
    series: Sequence[Array]
    """(K,) of each recording, in the unit."""


def drawn_signals(episode: RecordedEpisode) -> list[Drawn]:
    """A blade's tip in lag and flap; of a model of one's own the displacements that it tells, or the readings of its sensors."""
    plant = episode.blade.truth
    points = len(plant.tip_displacement)
    if not points:
        return [
            Drawn(sensor.name, sensor.unit, [each.readings[:, row] for each in episode.recordings])
            for row, sensor in enumerate(plant.sensors)
        ]
    titles = TIP if episode.has_shape else [f"displacement {point}" for point in range(points)]
    return [Drawn(title, "µm", [1e6 * each.tip[:, row] for each in episode.recordings]) for row, title in enumerate(titles)]


def words(episode: RecordedEpisode) -> str:
    """What they are, in one word or two."""
    if episode.has_shape:
        return "tip displacement"
    return "displacements" if len(episode.blade.truth.tip_displacement) else "readings"
