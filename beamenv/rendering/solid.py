"""The blade as a scene shows it: how many times larger than life it bends, and where its patches are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.sensor_places import SensorPlaces
from beamenv.blade.shape import bodies, magnification, patch, quadrilaterals
from beamenv.patches.layout import SIDES
from beamenv.rendering.largest import usual_of

Array = NDArray[np.float64]

STATIONS = 49
"""Evenly spaced; the edges of the patches are stations too."""
SHOWN_DEFLECTION = 0.15
"""Share of the span that the scenario's largest deflection of the tip is drawn as, at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A blade at one instant, in m as drawn; coordinates are lag, flap, span."""

    bodies: tuple[Array, ...]
    """(stations, K, 3) each: the corners of the outlines."""
    actuators: Array
    """(a, 4, 3): corners, counter-clockwise from outside."""
    sensors: Array
    """(s, 4, 3), likewise."""
    points: Array
    """(k, 3): the sensors that are no patches."""


class BladeSolid:
    """A blade and its patches; ``pose`` bends and twists them, ``magnification`` times larger than life: so that the ``largest``
    deflection (m) of its tip, if None that of a step of the reference load, is drawn as a share of its span.

    ``stations`` (m from the root), of which ``even`` indexes evenly spaced ones.
    """

    def __init__(self, blade: Blade, largest: float | None = None) -> None:
        beam, patches = blade.beam, blade.config.patches
        self.largest = usual_of(blade.plant).deflection if largest is None else largest
        self.magnification = magnification(self.largest, SHOWN_DEFLECTION * beam.length)
        inlays = [[each for group in patches.groups(side) for each in group.inlays(side, beam.length)] for side in SIDES]
        spans = [np.array([[each.start, each.start + each.length] for each in side]).reshape(-1, 2) for side in inlays]
        self.places = SensorPlaces.on(blade)
        even = np.linspace(0.0, beam.length, STATIONS)
        self.stations = np.unique(
            np.concatenate([even, *(each.ravel() for each in spans), *(each.span for each in self.places.points)])
        )
        self.even = np.searchsorted(self.stations, even)
        self._bodies = bodies(beam, self.stations)
        self._actuators, self._sensors = (
            [(patch(beam, each, ends), np.searchsorted(self.stations, ends)) for each, ends in zip(side, span, strict=True)]
            for side, span in zip(inlays, spans, strict=True)
        )

        self._points = [(skin, np.searchsorted(self.stations, skin.span)) for skin in self.places.points]

    def pose(self, displacement: Array) -> Pose:
        """The blade displaced by lag, flap (m) and twist (rad) at its stations, (3, stations)."""
        drawn = self.magnification * displacement
        actuators, sensors = (
            np.concatenate([np.zeros((0, 4, 3)), *(quadrilaterals(skin.displaced(drawn[:, ends])[None]) for skin, ends in side)])
            for side in (self._actuators, self._sensors)
        )
        points = np.concatenate([np.zeros((0, 3)), *(skin.displaced(drawn[:, at])[0] for skin, at in self._points)])
        return Pose(tuple(skin.displaced(drawn) for skin in self._bodies), actuators, sensors, points)
