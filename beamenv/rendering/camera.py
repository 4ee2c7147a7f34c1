"""A camera: true perspective from points in space to points on a screen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.rendering.canvas import Frame

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """An eye in space (lag, flap, span) with a flat screen before it."""

    eye: Array
    """(3,), m."""
    axes: Array
    """(3, 3): unit vectors to the right, down and forwards."""
    scale: float
    """Pixels per unit of tangent of the angle from the axis."""
    origin: Array
    """(2,), px: where the forward axis meets the screen."""

    @classmethod
    def facing(cls, points: Array, towards: Array, distance: float, frame: Frame) -> Camera:
        """The camera ``distance`` (m) from the middle of ``points`` (k, 3), in the direction ``towards`` (3,), upright, that just
        fits all of them into ``frame``.
        """
        forward = -towards / np.linalg.norm(towards)
        right = np.cross(forward, [0.0, 1.0, 0.0])
        right /= np.linalg.norm(right)
        eye = 0.5 * (points.min(axis=0) + points.max(axis=0)) - distance * forward
        plain = cls(eye, np.stack([right, np.cross(forward, right), forward]), 1.0, np.zeros(2))
        screen, _ = plain.project(points)
        low, high = screen.min(axis=0), screen.max(axis=0)
        scale = float(np.min(np.array([frame.width, frame.height]) / (high - low)))
        centre = np.array([frame.left + 0.5 * frame.width, frame.top + 0.5 * frame.height])
        return cls(eye, plain.axes, scale, centre - 0.5 * scale * (low + high))

    def project(self, points: Array) -> tuple[Array, Array]:
        """Screen points (…, 2), px, and depths (…,), m from the eye along the axis, of points (…, 3)."""
        seen = (points - self.eye) @ self.axes.T
        depth = seen[..., 2]
        return self.origin + self.scale * seen[..., :2] / depth[..., None], depth


def faces_camera(corners: Array) -> NDArray[np.bool_]:
    """(k,): which polygons (k, c, 2) on the screen, counter-clockwise from outside the body they bound, turn their outside to
    the eye: their signed area tells, in perspective too.
    """
    x, y = corners[..., 0], corners[..., 1]
    area = (x * np.roll(y, -1, axis=-1) - y * np.roll(x, -1, axis=-1)).sum(axis=-1)
    turned: NDArray[np.bool_] = area < 0.0
    return turned
