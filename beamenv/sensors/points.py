"""How points of a blade move: rows of their displacement and of the acceleration that an accelerometer there feels.

A point of a section at r = (x, y, 0) from the pitch axis, turned with the pretwist, is displaced by u + ϑ × r, with u the
displacement of the axis and ϑ the rotation of the section. In axes that turn with the hub about ŷ its acceleration is

    p̈ + 2Ω ŷ × ṗ − Ω² (p − ŷŷᵀp) + Ω̇ ŷ × p,

and an accelerometer on it, whose axis n turns with the section, feels n of it and, since δn = ϑ × n, the share ϑ × n of that of the
blade as it stands. Where it stands is taken without its steady deformation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.structure import RotatingBeam

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class PointRows:
    """Rows of a point of a blade with N trial functions, along lag, flap and span."""

    moved: Array
    """(3, N), m: its displacement."""
    turned: Array
    """(3, N), rad: the rotation of its section."""
    stands: Array
    """(3,), m: where it stands, from the hub's centre."""


def point_rows(beam: RotatingBeam, position: float | None, point: tuple[float, ...], name: str) -> PointRows:
    """The rows of a point at ``position`` (m; None: the tip), ``point`` (x, y), m, of its section; ``ValueError`` off the blade."""
    z = beam.length if position is None else position
    if z > beam.length * (1.0 + 1e-9):
        raise Refused(f"{name}.position", z, f"at most {beam.length:g} (m), the length of the blade")
    at = np.array([min(z, beam.length)])
    rows = {field: row[0] for field, row in beam.displacements(at).items()}
    angle = float(beam.planform.angle(at)[0])
    arm = np.array([point[0] * np.cos(angle) - point[1] * np.sin(angle), point[0] * np.sin(angle) + point[1] * np.cos(angle), 0.0])
    moved = np.stack([rows["u"], rows["v"], rows["s"]])
    turned = np.stack([rows["theta_x"], rows["theta_y"], rows["phi"]])
    return PointRows(
        moved=moved + np.cross(turned, arm, axisa=0, axisc=0),
        turned=turned,
        stands=arm + np.array([0.0, 0.0, beam.hub_radius + float(at[0])]),
    )


def along(direction: tuple[float, ...]) -> Array:
    """(3,), of length 1."""
    return np.asarray(direction) / np.linalg.norm(direction)


def felt_acceleration(rows: PointRows, direction: Array, speed: float, speeding_up: float = 0.0) -> tuple[Array, Array, Array]:
    """(N,) three times: what an accelerometer at a point, of axis ``direction`` (3,), feels per coefficient, per rate and per
    second rate of the coefficients, on a blade that turns at ``speed`` (rad/s), the faster by ``speeding_up`` (rad/s²).
    """
    moved, axis = rows.moved, np.array([0.0, 1.0, 0.0])
    in_plane = np.diag([1.0, 0.0, 1.0])
    coriolis = 2.0 * speed * np.cross(axis, moved, axisa=0, axisb=0, axisc=0)
    field = -(speed**2) * in_plane + speeding_up * np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])  # Ω̇ ŷ ×
    tilted = np.cross(rows.turned, direction, axisa=0, axisc=0)
    return direction @ field @ moved + field @ rows.stands @ tilted, direction @ coriolis, direction @ moved
