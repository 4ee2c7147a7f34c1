"""The blade as a solid in space: a pretwisted, tapered box that bends and twists, with its patches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import build_plant
from beamenv.blade.config import BladeConfig
from beamenv.plant.reduction import REFERENCE_LOAD
from beamenv.scenarios.load_cases import static_deflection

Array = NDArray[np.float64]

STATIONS = 49
"""Evenly spaced; the edges of the patches are stations too."""
SHOWN_DEFLECTION = 0.075
"""Share of the span that the largest static tip deflection under the reference load is drawn as, at most: a step of the
greatest load of the default scenario, with its overshoot, then reaches three times as far."""
CORNERS = np.array([[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]])
"""Of the section, in widths and depths: the top wall runs from the first to the second, the bottom wall between the others."""


def reference_deflection(config: BladeConfig) -> float:
    """Static tip deflection, m, under the reference load in lag or in flap, whichever is larger."""
    plant = build_plant(config)
    tip = plant.tip_displacement @ static_deflection(plant, np.diag([REFERENCE_LOAD] * 2)).T
    return float(np.linalg.norm(tip, axis=0).max())


def magnification(length: float, deflection: float) -> float:
    """How many times larger than life a ``deflection`` is drawn on a blade: one significant digit."""
    wanted = SHOWN_DEFLECTION * length / deflection
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * np.floor(wanted / power))


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A blade at one instant, in m as drawn; coordinates are lag, flap, span."""

    walls: Array
    """(stations, 4, 3): the section's corners."""
    actuators: Array
    """(a, 4, 3): corners, counter-clockwise from above."""
    sensors: Array
    """(s, 4, 3): the same from below, where they lie in the bottom wall."""


class BladeSolid:
    """The outer contour of a blade and its patches; ``pose`` bends and twists them, ``magnification`` times larger than life.

    ``stations`` (m from the root), of which ``even`` indexes evenly spaced ones.
    """

    def __init__(self, config: BladeConfig) -> None:
        beam, patches = config.beam, config.patches
        self.reference_deflection = reference_deflection(config)
        self.magnification = magnification(beam.length, self.reference_deflection)
        starts = [patches.actuator_positions(beam.length), patches.sensor_positions(beam.length)]
        edges = [np.array(start)[:, None] + patches.length * np.array([0.0, 1.0]) for start in starts]
        even = np.linspace(0.0, beam.length, STATIONS)
        self.stations = np.unique(np.concatenate([even, *(each.ravel() for each in edges)]))
        self.even = np.searchsorted(self.stations, even)
        self._actuators, self._sensors = (np.searchsorted(self.stations, each) for each in edges)
        share = self.stations / beam.length
        size = (1.0 - share + share / beam.taper)[:, None]
        self._angle = np.radians(beam.presetting_deg + beam.pretwist_deg * share)
        outline = size[..., None] * CORNERS * [beam.width, beam.depth] + beam.thickness * CORNERS
        half = np.full((len(share), 1), 0.5 * patches.width)
        self._outline = outline
        self._on_top = np.stack([np.hstack([-half, half]), outline[:, :2, 1]], axis=-1)
        self._below = np.stack([np.hstack([half, -half]), outline[:, 2:, 1]], axis=-1)

    def pose(self, displacement: Array) -> Pose:
        """The blade displaced by lag, flap (m) and twist (rad) at its stations, (3, stations)."""
        lag, flap, twist = self.magnification * displacement
        angle = self._angle + twist
        axes = np.stack([np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)], axis=-1).reshape(-1, 2, 2)
        shift = np.stack([lag, flap], axis=-1)[:, None]
        walls, top, below = (self._placed(each, axes, shift) for each in (self._outline, self._on_top, self._below))
        return Pose(walls, _patches(top, self._actuators), _patches(below, self._sensors))

    def _placed(self, section: Array, axes: Array, shift: Array) -> Array:
        """Points (stations, c, 3) of the points (stations, c, 2) of the sections, turned and shifted."""
        across = section @ axes.transpose(0, 2, 1) + shift
        span = np.broadcast_to(self.stations[:, None, None], (*across.shape[:2], 1))
        return np.concatenate([across, span], axis=-1)


def quadrilaterals(walls: Array) -> Array:
    """(4 (stations − 1) + 1, 4, 3): faces of the walls (stations, 4, 3) between stations and last the face of the tip, each
    counter-clockwise from outside.
    """
    following = np.roll(walls, -1, axis=1)
    faces = np.stack([walls[:-1], walls[1:], following[1:], following[:-1]], axis=2)
    return np.concatenate([faces.reshape(-1, 4, 3), walls[-1, ::-1][None]])


def _patches(lines: Array, edges: NDArray[np.intp]) -> Array:
    """(k, 4, 3): corners of patches between two lines (stations, 2, 3) along the span, from station to station (k, 2)."""
    start, end = lines[edges[:, 0]], lines[edges[:, 1]]
    return np.stack([start[:, 0], end[:, 0], end[:, 1], start[:, 1]], axis=1)
