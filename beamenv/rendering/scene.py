"""The blade as the camera sees it: hidden faces hidden, patches coloured."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.shape import edges, sides
from beamenv.rendering.camera import Camera, faces_camera
from beamenv.rendering.canvas import Canvas, Frame
from beamenv.rendering.history import Instant
from beamenv.rendering.palette import INK, LIGHT, OUTPUT_SCALE, VOLTAGE_SCALE, Shades, Theme, colour_table, colours_of
from beamenv.rendering.solid import SHOWN_DEFLECTION, BladeSolid, Pose

Array = NDArray[np.float64]

PLACE = Frame(8.0, 100.0, 618.0, 368.0)
MARGIN = 8.0
REACH = 1.1
"""Times ``SHOWN_DEFLECTION`` that the tip may move up or down without leaving the scene."""
SENSOR_DROP = 0.15
"""Share of the span by which sensors are drawn below the bottom wall they lie in: nobody could see them there."""
TOWARDS, DISTANCE = np.array([-0.80, 0.62, -0.62]), 1.5
"""Where the eye is from the middle of the blade, with positive pretwist: the direction (lag, flap, span) and how many spans."""
SUN = np.array([0.75, 0.65, -0.45])
"""Towards the light, with positive pretwist: it turns the top wall from it."""
RIBS = 4
"""At every n-th of the even stations a line across the walls shows how they bend and twist."""
RIB = 0.90
"""Share of a wall's brightness that a rib has."""
ARROW, ARROW_AT = 0.17, 0.88
"""Shares of the span: how long the largest load is drawn, and where."""
HEAD, SHAFT, SHORTEST = 9.0, 2.0, 4.0
"""Pixels: of an arrow's head and shaft, and below which none is drawn."""
HUB_LENGTH = 0.1
"""Share of the span that the hub is long, at most."""
DARK = 0.7
"""Values of the colour scales beyond which white letters are read better."""
POINT = 5.0
"""Half width, px, of the diamond that is a sensor at a point."""
DIAMOND = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
NARROW = 8.0
"""Height, px, below which a patch has no room for its number."""
CROSS = 2.0
"""Width, px, of the lines that cross out what is dead."""
NO_LOAD = np.zeros(2)


class Face(NamedTuple):
    """What the camera sees of a face of a body."""

    depth: float
    """m from the eye."""
    corners: Array
    """(c, 2), px."""
    colour: list[int]
    ribbed: bool
    """Whether a line is drawn along its far station."""


class Values(NamedTuple):
    """What patches and sensors of a blade are worth now."""

    volts: Array
    """(a,), −1 … 1."""
    outputs: Array
    """(s,) readings, −1 … 1."""
    dead_actuators: NDArray[np.bool_]
    """(a,)."""
    dead_sensors: NDArray[np.bool_]
    """(s,)."""

    @classmethod
    def of(cls, instant: Instant, actuators: int, limit: float) -> Values:
        """Of an instant: voltages as shares of ``limit`` (V); ganged actuators share one, and sound is what nothing is said of."""
        readings = len(instant.reading)
        dead_actuators = instant.actuator_gain == 0.0 if len(instant.actuator_gain) else np.zeros(1, dtype=bool)
        dead_sensors = instant.sensor_gain == 0.0 if len(instant.sensor_gain) else np.zeros(readings, dtype=bool)
        volts, dead = (np.broadcast_to(each, (actuators,)) for each in (instant.volts / limit, dead_actuators))
        return cls(volts, instant.reading, dead, dead_sensors)


class Scene:
    """Draws a ``BladeSolid`` on a canvas, in a part of it."""

    def __init__(self, blade: Blade, largest: float | None = None, place: Frame = PLACE, theme: Theme = LIGHT) -> None:
        self.solid, self._place, self._theme = BladeSolid(blade, largest), place, theme
        self._length = blade.config.beam.length
        beam = blade.config.beam
        length = beam.length
        self._drop = np.array([0.0, -SENSOR_DROP * length, 0.0])
        self._rest = self.solid.pose(np.zeros((3, len(self.solid.stations))))
        section = blade.beam.section
        self._edges = edges(section)
        held = hub(self._rest.bodies, length)
        self._ribs = set(self.solid.even[RIBS::RIBS].tolist())
        middle = np.radians(beam.presetting_deg + 0.5 * beam.pretwist_deg)
        side = np.array([-1.0 if np.sin(middle) < 0.0 else 1.0, 1.0, 1.0])  # look at the side that the top wall is turned to
        self._light = side * SUN / np.linalg.norm(SUN)
        ends = np.concatenate([each[-1] for each in self._rest.bodies])
        tip = [ends + np.array([0.0, reach * SHOWN_DEFLECTION * length, 0.0]) for reach in (-REACH, REACH)]
        points = [*self._rest.bodies, self._rest.sensors + self._drop, *held, *tip]
        self._camera = Camera.facing(
            np.concatenate([each.reshape(-1, 3) for each in points]),
            towards=side * TOWARDS,
            distance=DISTANCE * length,
            frame=Frame(place.left + MARGIN, place.top + MARGIN, place.width - 2.0 * MARGIN, place.height - 2.0 * MARGIN),
        )
        self._above = faces_camera(self._camera.project(self._rest.sensors)[0])  # in an upper face, where most lie in a lower one
        self._hub = self._seen(held, theme.hub)
        self._voltage_colours, self._output_colours = colour_table(VOLTAGE_SCALE), colour_table(OUTPUT_SCALE)

    def draw_rest(self, canvas: Canvas) -> None:
        """Where the blade is when nothing moves it."""
        pale = self._theme.pale
        for body, sharp in zip(self._rest.bodies, self._edges, strict=True):
            lines, _ = self._camera.project(body[self.solid.even])
            for line in lines[:, sharp].transpose(1, 0, 2):
                for start in range(0, len(line) - 1, 2):
                    canvas.line(line[start : start + 2], pale)
            canvas.line(lines[-1], pale, closed=True)

    def draw(self, canvas: Canvas, displacement: Array, values: Values, load: Array = NO_LOAD) -> None:
        """The blade displaced by lag, flap (m) and twist (rad), (3, stations), its patches in the colours of ``values``, dead ones
        crossed out, and the line load in lag and flap (2,) as a share of the scenario's largest.
        """
        canvas.open(self._place)
        pose = self.solid.pose(displacement)
        self._draw_leaders(canvas, pose)
        volts, outputs = values.volts, values.outputs
        patches, points = self._by_patches(outputs), outputs[self.solid.places.of_points]
        dead = self._by_patches(values.dead_sensors.astype(float)) > 0.0
        self._draw_patches(canvas, self._dropped(pose), colours_of(self._output_colours, patches), patches, dead)
        body = self._theme.body
        _draw_faces(canvas, [face for each in pose.bodies for face in self._seen([sides(each), each[-1:]], body, each.shape[1])])
        self._draw_patches(canvas, pose.actuators, colours_of(self._voltage_colours, volts), volts, values.dead_actuators)
        self._draw_points(
            canvas, pose.points, colours_of(self._output_colours, points), values.dead_sensors[self.solid.places.of_points]
        )
        _draw_faces(canvas, self._hub)
        self._draw_load(canvas, pose, load)
        canvas.develop(self._place)

    def _draw_load(self, canvas: Canvas, pose: Pose, load: Array) -> None:
        """An arrow that ends in the middle of the blade, near its tip: a uniform line load pushes there as everywhere."""
        station = int(np.argmin(np.abs(self.solid.stations - ARROW_AT * self._length)))
        end = np.mean([each[station].mean(axis=0) for each in pose.bodies], axis=0)
        begin = end - np.array([*(ARROW * self._length * np.clip(load, -1.0, 1.0)), 0.0])
        (tail, head), _ = self._camera.project(np.stack([begin, end]))
        size = float(np.linalg.norm(head - tail))
        if not size > SHORTEST:
            return
        ahead = (head - tail) / size
        across, back = np.array([-ahead[1], ahead[0]]), head - min(HEAD, size) * ahead
        canvas.line([tail.tolist(), back.tolist()], self._theme.load, SHAFT)
        canvas.polygon(np.stack([head, back + 0.45 * HEAD * across, back - 0.45 * HEAD * across]), self._theme.load)

    def _dropped(self, pose: Pose) -> Array:
        """(s, 4, 3): sensor patches where they are drawn, with the side up that is seen at rest."""
        return np.where(self._above[:, None, None], pose.sensors, pose.sensors[:, ::-1]) + self._drop

    def _by_patches(self, outputs: Array) -> Array:
        """(s,): 0 of a patch that is not read."""
        channels = self.solid.places.of_patches
        return np.where(channels < 0, 0.0, outputs[channels])

    def _draw_points(self, canvas: Canvas, points: Array, colours: list[list[int]], dead: NDArray[np.bool_]) -> None:
        """Diamonds where sensors sit that are no patches, seen through the blade."""
        if not len(points):
            return
        middles, _ = self._camera.project(points)
        for middle, colour, is_dead in zip(middles, colours, dead.tolist(), strict=True):
            canvas.polygon(middle + POINT * DIAMOND, colour)
            canvas.line(middle + POINT * DIAMOND, self._theme.outline, closed=True)
            if is_dead:
                self._cross_out(canvas, middle + POINT * np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]]))

    def _draw_leaders(self, canvas: Canvas, pose: Pose) -> None:
        """From where sensors lie to where they are drawn."""
        middles = pose.sensors.mean(axis=1)
        ends, _ = self._camera.project(np.stack([middles, middles + self._drop], axis=1))
        for leader in ends:
            canvas.line(leader, self._theme.quiet)

    def _draw_patches(
        self, canvas: Canvas, patches: Array, colours: list[list[int]], values: Array, dead: NDArray[np.bool_]
    ) -> None:
        """Patches (k, 4, 3), those whose upper side is seen, numbered from the root; dead ones are crossed out."""
        corners, _ = self._camera.project(patches)
        for k in np.flatnonzero(faces_camera(corners)).tolist():
            canvas.polygon(corners[k], colours[k])
            canvas.line(corners[k], self._theme.outline, closed=True)
            ink = "#ffffff" if abs(values[k]) > DARK else INK
            if dead[k]:
                self._cross_out(canvas, corners[k], ink)
            elif np.linalg.norm(corners[k, 3] - corners[k, 0]) > NARROW:
                x, y = corners[k].mean(axis=0).tolist()
                canvas.write(f"{k + 1}", x, y, ink, "number", anchor=0.5)

    def _cross_out(self, canvas: Canvas, corners: Array, ink: str = INK) -> None:
        for line in (corners[[0, 2]], corners[[1, 3]]):
            canvas.line(line, ink, CROSS)

    def _seen(self, surfaces: Sequence[Array], colours: Shades, corners_around: int = 0) -> list[Face]:
        """Faces (k, c, 3) of some surfaces, the farthest first, those turned away left out. Of a body with so many corners around
        there are ribs across the first surface.
        """
        found: list[Face] = []
        for surface in surfaces:
            corners, depth = self._camera.project(surface)
            seen = np.flatnonzero(faces_camera(corners))
            far, shades = depth[seen].mean(axis=-1).tolist(), self._shades(surface[seen], *colours)
            around = corners_around if surface is surfaces[0] else 0
            ribbed = [bool(around) and k // around + 1 in self._ribs for k in seen.tolist()]
            found += map(Face, far, corners[seen], shades, ribbed)
        return sorted(found, key=attrgetter("depth"), reverse=True)

    def _shades(self, faces: Array, shade: Sequence[float], lit: Sequence[float]) -> list[list[int]]:
        normals = np.cross(faces, np.roll(faces, -1, axis=1)).sum(axis=1)
        size = np.maximum(np.linalg.norm(normals, axis=-1), np.finfo(np.float64).tiny)  # of nothing between stations all but one
        brightness = 0.5 + 0.5 * (normals @ self._light) / size
        colours: list[list[int]] = np.rint(np.array(shade) + brightness[:, None] * np.subtract(lit, shade)).astype(int).tolist()
        return colours


def _draw_faces(canvas: Canvas, faces: Sequence[Face]) -> None:
    for face in faces:
        canvas.polygon(face.corners, face.colour)
        if face.ribbed:
            canvas.line(face.corners[1:3], [round(RIB * part) for part in face.colour])


def _around(points: Array) -> Array:
    """(4, 3): the corners of a rectangle around points of a plane, in the order of a box's."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = np.array([high[0], high[0], low[0], low[0]]), np.array([low[1], high[1], high[1], low[1]])
    return np.stack([x, y, np.full(4, points[0, 2])], axis=-1)


def hub(walls: Sequence[Array], length: float) -> list[Array]:
    """Faces (k, c, 3), m, of the block that holds the root of a blade ``length`` (m) long with outer walls (stations, K, 3): its
    sides, its outer and its inner end.
    """
    root = np.concatenate([each[0] for each in walls])
    deep = min(2.5 * float(np.ptp(root[:, 1])), HUB_LENGTH * length)
    root = _around(root) if len(walls) > 1 else root
    middle = root.mean(axis=0)
    block = np.stack([middle + 1.25 * (root - middle)] * 2)
    block[0, :, 2] = -deep
    return [sides(block), block[-1:], block[:1, ::-1]]
