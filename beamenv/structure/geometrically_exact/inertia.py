"""Inertia of sections that rotate with the hub about ŷ: mass, Coriolis, centrifugal and Euler's forces, exactly.

A point of a section stands at p = r + a, a turning with the section. Its acceleration is p̈ + 2Ω ŷ × ṗ − Ω² P p + Ω̇ ŷ × p with
P = 1 − ŷŷᵀ. An increment moves it by δu + ϑ × a + ½ ϑ × (ϑ × a). With d = ∫ρ a dA and J = ∫ρ a aᵀ dA everything follows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.geometrically_exact.kinematics import INCREMENT, MOVE, SPIN, Placement
from beamenv.structure.geometrically_exact.rotations import hat

Array = NDArray[np.float64]

AXIS = np.array([0.0, 1.0, 0.0])
AROUND = hat(AXIS)
PLANE = np.diag([1.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, eq=False)
class SpinningSections:
    """Sections at S stations, where and how the blade stands."""

    arm: Array
    """r (S, 3), m, from the hub's centre."""
    mass: Array
    """(S,), kg/m."""
    first: Array
    """d (S, 3), kg."""
    second: Array
    """J (S, 3, 3), kg m."""

    @classmethod
    def of(cls, placement: Placement, inertia: Array, arm: Array) -> SpinningSections:
        """From ∫ρ (1, x, y, x², xy, y²) dA (S, 6) in the sections' axes and r (S, 3) of the unloaded blade."""
        first, second = np.zeros((len(inertia), 3)), np.zeros((len(inertia), 3, 3))
        first[:, 0], first[:, 1] = inertia[:, 1], inertia[:, 2]
        second[:, 0, 0], second[:, 0, 1], second[:, 1, 0], second[:, 1, 1] = inertia[:, [3, 4, 4, 5]].T
        frame = placement.frame
        return cls(
            arm=arm + placement.displacement,
            mass=inertia[:, 0],
            first=(frame @ first[..., None])[..., 0],
            second=frame @ second @ frame.swapaxes(-1, -2),
        )

    @property
    def centrifugal(self) -> Array:
        """Force per Ω² and metre on increments (S, 12)."""
        outward = self.arm @ PLANE
        force = np.zeros((len(self.mass), INCREMENT))
        force[:, MOVE] = self.mass[:, None] * outward + self.first @ PLANE
        force[:, SPIN] = np.cross(self.first, outward) + _axial(PLANE @ self.second)
        return force

    @property
    def euler(self) -> Array:
        """Force per Ω̇ and metre on increments (S, 12)."""
        ahead = -self.arm @ AROUND.T
        force = np.zeros((len(self.mass), INCREMENT))
        force[:, MOVE] = self.mass[:, None] * ahead - self.first @ AROUND.T
        force[:, SPIN] = np.cross(self.first, ahead) - _axial(AROUND @ self.second)
        return force

    @property
    def centrifugal_softening(self) -> Array:
        """(S, 12, 12), per Ω²: by how much the centrifugal force grows with an increment, to be taken from the stiffness."""
        form = np.zeros((len(self.mass), INCREMENT, INCREMENT))
        outward, moved = self.arm @ PLANE, -PLANE @ hat(self.first)
        form[:, MOVE, MOVE] = self.mass[:, None, None] * PLANE
        form[:, MOVE, SPIN], form[:, SPIN, MOVE] = moved, moved.swapaxes(-1, -2)
        across = outward[:, :, None] * self.first[:, None, :] + PLANE @ self.second
        form[:, SPIN, SPIN] = (
            _times_identity(self.second)
            - self.second
            - AROUND @ self.second @ AROUND.T
            + 0.5 * (across + across.swapaxes(-1, -2))
            - _times_identity(across)
        )
        return form

    @property
    def mass_form(self) -> Array:
        """(S, 12, 12)."""
        form = np.zeros((len(self.mass), INCREMENT, INCREMENT))
        moved = hat(self.first)
        form[:, MOVE, MOVE] = self.mass[:, None, None] * np.eye(3)
        form[:, MOVE, SPIN], form[:, SPIN, MOVE] = -moved, moved
        form[:, SPIN, SPIN] = _times_identity(self.second) - self.second
        return form

    @property
    def gyroscopic(self) -> Array:
        """(S, 12, 12), per Ω: skew."""
        form = np.zeros((len(self.mass), INCREMENT, INCREMENT))
        moved = hat(self.first)
        form[:, MOVE, MOVE] = 2.0 * self.mass[:, None, None] * AROUND
        form[:, MOVE, SPIN], form[:, SPIN, MOVE] = -2.0 * AROUND @ moved, 2.0 * moved @ AROUND
        form[:, SPIN, SPIN] = 2.0 * hat(self.second @ AXIS)
        return form


def _axial(moment: Array) -> Array:
    """ε_kij B_ji (S, 3)."""
    return np.stack(
        [moment[:, 2, 1] - moment[:, 1, 2], moment[:, 0, 2] - moment[:, 2, 0], moment[:, 1, 0] - moment[:, 0, 1]], axis=-1
    )


def _times_identity(matrix: Array) -> Array:
    return np.asarray(np.trace(matrix, axis1=-2, axis2=-1)[:, None, None] * np.eye(3))
