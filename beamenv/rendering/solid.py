"""The blade as a scene shows it: how many times larger than life it bends, and where its patches are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.shape import body, magnification, patch, quadrilaterals
from beamenv.patches.layout import ACTUATOR_WALL, SENSOR_WALL
from beamenv.plant.plant import Plant
from beamenv.plant.signals import REFERENCE_LOAD
from beamenv.scenarios.load_cases import static_deflection

Array = NDArray[np.float64]

STATIONS = 49
"""Evenly spaced; the edges of the patches are stations too."""
SHOWN_DEFLECTION = 0.075
"""Share of the span that the largest static tip deflection under the reference load is drawn as, at most: a step of the
greatest load of the default scenario, with its overshoot, then reaches three times as far."""


def reference_deflection(plant: Plant) -> float:
    """Static tip deflection, m, under the reference load in lag or in flap, whichever is larger."""
    tip = plant.tip_displacement @ static_deflection(plant, np.diag([REFERENCE_LOAD] * 2)).T
    return float(np.linalg.norm(tip, axis=0).max())


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A blade at one instant, in m as drawn; coordinates are lag, flap, span."""

    walls: Array
    """(stations, K, 3): the section's outer corners."""
    actuators: Array
    """(a, 4, 3): corners, counter-clockwise from outside."""
    sensors: Array
    """(s, 4, 3), likewise."""


class BladeSolid:
    """A blade and its patches; ``pose`` bends and twists them, ``magnification`` times larger than life.

    ``stations`` (m from the root), of which ``even`` indexes evenly spaced ones.
    """

    def __init__(self, blade: Blade) -> None:
        beam, patches = blade.beam, blade.config.patches
        self.reference_deflection = reference_deflection(blade.plant)
        self.magnification = magnification(self.reference_deflection, SHOWN_DEFLECTION * beam.length)
        starts = [patches.actuator_positions(beam.length), patches.sensor_positions(beam.length)]
        spans = [np.array(start)[:, None] + patches.length * np.array([0.0, 1.0]) for start in starts]
        even = np.linspace(0.0, beam.length, STATIONS)
        self.stations = np.unique(np.concatenate([even, *(each.ravel() for each in spans)]))
        self.even = np.searchsorted(self.stations, even)
        self._body = body(beam, self.stations)
        walls = (ACTUATOR_WALL, SENSOR_WALL)
        self._actuators, self._sensors = (
            (patch(beam, wall, patches.width, span.ravel()), np.searchsorted(self.stations, span.ravel()))
            for wall, span in zip(walls, spans, strict=True)
        )

    def pose(self, displacement: Array) -> Pose:
        """The blade displaced by lag, flap (m) and twist (rad) at its stations, (3, stations)."""
        drawn = self.magnification * displacement
        actuators, sensors = (
            quadrilaterals(skin.displaced(drawn[:, ends]).reshape(-1, 2, 2, 3)) for skin, ends in (self._actuators, self._sensors)
        )
        return Pose(self._body.displaced(drawn), actuators, sensors)
