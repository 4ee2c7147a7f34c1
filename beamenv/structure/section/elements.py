"""The solid elements of a section: displacement shapes over elements through the wall, and what they strain.

In a frame that turns with the blade's pretwist at k rad/m a displacement g(x, y, z) has the strains ε = B g + S g′, where
g′ = ∂g/∂z at fixed place in the section, and

    B g = [∂x gx, ∂y gy, ∂y gx + ∂x gy, ∂x gz, ∂y gz, 0] + k S (ẑ × g − (x ∂y − y ∂x) g),        S g = [0, 0, 0, gx, gy, gz]

for (ε_xx, ε_yy, γ_xy, γ_xz, γ_yz, ε_zz): exact for small strains, whatever the pretwist.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed
from beamenv.structure.section.mesh import Mesh
from beamenv.structure.walls.laminate import Laminate, Ply

Array = NDArray[np.float64]

ACROSS = 3
"""Polynomial order through the wall."""

RIGID = 6
"""Translations along x, y, z and turns about them."""


@lru_cache
def lobatto_nodes(order: int) -> Array:
    """(order + 1,) nodes on −1 … 1."""
    inner = legendre.legroots(legendre.legder(np.eye(order + 1)[order])).real if order > 1 else np.zeros(0)  # complex from 2.5 on
    nodes = np.concatenate([[-1.0], np.sort(inner), [1.0]])
    nodes.setflags(write=False)
    return nodes


@lru_cache
def inverse_vandermonde(order: int) -> tuple[Array, Array]:
    """(order + 1, order + 1): Legendre coefficients of the polynomials that are 1 at one Lobatto node and 0 at the others, and
    those of their slopes.
    """
    inverse = np.asarray(np.linalg.inv(legendre.legvander(lobatto_nodes(order), order)), dtype=np.float64)
    slopes = np.zeros((order + 1, order + 1))
    derived = legendre.legder(np.eye(order + 1))
    slopes[: len(derived)] = derived
    return sealed(inverse), sealed(np.asarray(slopes @ inverse, dtype=np.float64))


def lagrange(order: int, at: Array) -> tuple[Array, Array]:
    """(len(at), order + 1): values and slopes of the polynomials that are 1 at one Lobatto node and 0 at the others."""
    inverse, slopes = inverse_vandermonde(order)
    there = legendre.legvander(at, order)
    return there @ inverse, there @ slopes


def through_wall(order: int, at: Array) -> tuple[Array, Array]:
    """(len(at), order + 1): values and slopes of Legendre's polynomials, the shapes of displacements across the wall.

    The first is what the wall does as a whole. Displacements of nodes across the wall in its place, whose differences strain it
    through its thickness, would leave (t/L)⁴ of their energy to the bending of a wall of length L, and rounding soon hides that.
    """
    slopes = legendre.legval(at, legendre.legder(np.eye(order + 1))).T
    return np.asarray(legendre.legvander(at, order), dtype=np.float64), np.asarray(slopes, dtype=np.float64)


def coefficients_through_wall(values: Array) -> Array:
    """(…, order + 1, k): coefficients of Legendre's polynomials from as many values at Lobatto's nodes across the wall."""
    return np.asarray(inverse_vandermonde(values.shape[-2] - 1)[0] @ values)


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """Points of E elements, Q each, with what the N shapes of an element do there."""

    x: Array
    y: Array
    """(E, Q), m."""
    weight: Array
    """(E, Q), m²; zero for points not integrated over."""
    value: Array
    along_x: Array
    along_y: Array
    """(E, Q, N): shapes and their slopes, 1/m."""

    def tables(self) -> Array:
        """(E, Q, 4N + 3): slopes along x, along y and around z, values, and 1, x, y."""
        around = self.x[..., None] * self.along_y - self.y[..., None] * self.along_x
        beam = np.stack([np.ones_like(self.x), self.x, self.y], axis=-1)
        return np.concatenate([self.along_x, self.along_y, around, self.value, beam], axis=-1)


def strain_of_tables(pretwist: float) -> tuple[Array, Array, Array]:
    """Strains per table of ``Places.tables``: of displacements B (4, 6, 3), of their derivatives S (6, 3), which take the values
    alone, and of the beam strains S Z (3, 6, 6) for (γx, γy, w′, θx′, θy′, φ′).
    """
    B, S, Z = np.zeros((4, 6, 3)), np.zeros((6, 3)), np.zeros((3, 6, RIGID))
    x, y, around, value = range(4)
    B[x, 0, 0] = B[y, 1, 1] = B[y, 2, 0] = B[x, 2, 1] = B[x, 3, 2] = B[y, 4, 2] = 1.0
    B[around, [3, 4, 5], [0, 1, 2]] = -pretwist
    B[value, 3, 1], B[value, 4, 0] = -pretwist, pretwist
    S[[3, 4, 5], [0, 1, 2]] = 1.0
    Z[0, [3, 4, 5], [0, 1, 2]] = 1.0
    Z[2, 3, 5], Z[1, 4, 5], Z[2, 5, 3], Z[1, 5, 4] = -1.0, 1.0, 1.0, -1.0
    return B, S, Z


def rigid_motion(x: Array, y: Array) -> Array:
    """(…, 3, 6): displacement of points (…) per translation along x, y, z and turn about them."""
    moved = np.zeros((*x.shape, 3, RIGID))
    for component in range(3):
        moved[..., component, component] = 1.0
    moved[..., 2, 3], moved[..., 2, 4], moved[..., 0, 5], moved[..., 1, 5] = y, -x, -y, x
    return moved


def places(mesh: Mesh, members: NDArray[np.intp], along: Array, across: Array, weight_along: Array, weight_across: Array) -> Places:
    """Points of some elements of one thickness (flat indices into (S, K)): ``along`` on −1 … 1 times ``across``, n in m."""
    P, d = (each.reshape(-1, 2)[members] for each in (mesh.points, mesh.directions))
    Q, e = (each.reshape(-1, 2)[members] for each in (mesh.last_points, mesh.last_directions))
    thickness = float(mesh.thickness[members[0] % len(mesh.edges)])
    share = 0.5 * (1.0 + along)[None, :, None, None]
    n = across[None, None, :, None]
    start, end = P[:, None, None] + n * d[:, None, None], Q[:, None, None] + n * e[:, None, None]
    position = (1.0 - share) * start + share * end
    by_along = np.broadcast_to(0.5 * (end - start), position.shape)
    by_across = np.broadcast_to((1.0 - share) * d[:, None, None] + share * e[:, None, None], position.shape)
    area = by_along[..., 0] * by_across[..., 1] - by_along[..., 1] * by_across[..., 0]
    values, slopes = lagrange(mesh.order, along)
    through, steepness = through_wall(ACROSS, 2.0 * across / thickness)
    shape = (len(along), len(across), -1)
    value = (values[:, None, :, None] * through[None, :, None, :]).reshape(shape)
    s = (slopes[:, None, :, None] * through[None, :, None, :]).reshape(shape)
    t = (values[:, None, :, None] * steepness[None, :, None, :]).reshape(shape) * (2.0 / thickness)
    along_x = (by_across[..., 1:] * s - by_along[..., 1:] * t) / area[..., None]
    along_y = (by_along[..., :1] * t - by_across[..., :1] * s) / area[..., None]
    count = len(members)
    return Places(
        x=position[..., 0].reshape(count, -1),
        y=position[..., 1].reshape(count, -1),
        weight=(np.abs(area) * weight_along[:, None] * weight_across).reshape(count, -1),
        value=np.broadcast_to(value, (count, *value.shape)).reshape(count, -1, value.shape[-1]),
        along_x=along_x.reshape(count, -1, value.shape[-1]),
        along_y=along_y.reshape(count, -1, value.shape[-1]),
    )


def layers(laminate: Laminate) -> list[tuple[float, float, Ply]]:
    """Bottom and top (m) of a wall's layers, equal neighbouring plies being one, but graded ones each by itself."""
    found: list[tuple[float, float, Ply]] = []
    for low, high, ply in zip(laminate.interfaces[:-1], laminate.interfaces[1:], laminate.plies, strict=True):
        if found and found[-1][2] == ply and ply.uniform is not None:
            found[-1] = (found[-1][0], high, ply)
        else:
            found.append((low, high, ply))
    return found


def stiffness_in_section(stiffness: Array, tangent: Array) -> Array:
    """(E, 6, 6), Pa, for the section's strains, of a stiffness (6, 6) in walls along ``tangent`` (E, 2)."""
    turned = turn_of_strains(tangent)
    return np.asarray(turned.swapaxes(-1, -2) @ stiffness @ turned)


def turn_of_strains(tangent: Array) -> Array:
    """(E, 6, 6): strains (ε_ss, ε_nn, γ_sn, γ_sz, γ_nz, ε_zz) along a wall from those along x, y."""
    a, b = tangent[:, 0], tangent[:, 1]
    turn = np.zeros((len(tangent), 6, 6))
    # s = (a, b), n = (b, −a)
    turn[:, 0, :3] = np.stack([a * a, b * b, a * b], axis=-1)
    turn[:, 1, :3] = np.stack([b * b, a * a, -a * b], axis=-1)
    turn[:, 2, :3] = np.stack([2.0 * a * b, -2.0 * a * b, b * b - a * a], axis=-1)
    turn[:, 3, 3], turn[:, 3, 4], turn[:, 4, 3], turn[:, 4, 4] = a, b, b, -a
    turn[:, 5, 5] = 1.0
    return turn
