"""How the walls of a section strain and how their points move, row by row (strain measures of thesis §2.2–2.3, corrected)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.walls.contour import WallPoints
from beamenv.structure.walls.laminate import WallLaw

Array = NDArray[np.float64]

STRAINS = ("w'", "theta_x'", "theta_y'", "gamma_x", "gamma_y", "u''", "v''", "phi'", "phi''")
"""Generalised strains of a section; γx = u' − θy, γy = v' + θx."""
W, TX, TY, GX, GY, UU, VV, PHI, PHI2 = range(len(STRAINS))

DISPLACEMENTS = ("u", "v", "s", "theta_x", "theta_y", "phi", "phi'", "u'", "v'")
"""Generalised displacements of a section."""
DU, DV, DS, DTX, DTY, DPHI, DPHI1, DU1, DV1 = range(len(DISPLACEMENTS))

SHEAR_THEORIES = ("higher_order", "first_order", "rigid")
SHEAR_FLOWS = ("consistent", "thesis")


@dataclass(frozen=True, slots=True, eq=False)
class LawTable:
    """Wall laws gathered at the points of S stations."""

    thickness: Array
    stiffness: Array
    transverse_shear: Array
    density: Array
    hoop_coupling: Array
    """(S, P), (S, P, 6, 6), (S, P, 7), (S, P, 7), (S, P, 6)."""

    @classmethod
    def gather(cls, laws: list[WallLaw], index: NDArray[np.intp]) -> LawTable:
        """Laws by their index at every point (S, P)."""
        return cls(
            thickness=np.array([law.thickness for law in laws])[index],
            stiffness=np.stack([law.stiffness for law in laws])[index],
            transverse_shear=np.stack([law.transverse_shear for law in laws])[index],
            density=np.stack([law.density for law in laws])[index],
            hoop_coupling=np.stack([law.hoop_coupling for law in laws])[index],
        )


@dataclass(frozen=True, slots=True, eq=False)
class ShearFlow:
    """How a closed cell completes the membrane shear so that its shear flow is constant."""

    twist: Array
    """ψ (S, P), m: per unit φ'."""
    relaxation: Array
    """χ (S, P, 4): per unit w', θx', θy', φ''."""
    warping: Array
    """F_w (S, P), m²: zero-mean sectorial area."""


def shear_flow_of(points: WallPoints, laws: LawTable, shear_flow: str) -> ShearFlow:
    """K15 ε0 + K55 γ constant around the cell (Berdichevsky, Armanios and Badir 1992), or the thesis' χ = 0, ψ = 2A/perimeter.

    ε0 counts with all its four parts: without that of φ'' the frequencies would depend on the axis the section is described from.
    """
    consistent = shear_flow == "consistent"
    compliance = 1.0 / laws.stiffness[..., 3, 3] if consistent else np.ones_like(points.x)
    coupling = laws.stiffness[..., 0, 3] * compliance if consistent else np.zeros_like(points.x)
    around = points.around(compliance)
    twist = (points.around(points.normal_distance) / around)[:, None] * compliance
    sectorial = points.integral_from_start(points.normal_distance - twist)
    warping = sectorial - (points.around(sectorial) / points.ds.sum(axis=1))[:, None]
    free = coupling[..., None] * np.stack([np.ones_like(points.x), points.y, -points.x, -warping], axis=-1)
    relaxation = (points.around(free) / around[:, None])[:, None, :] * compliance[..., None] - free
    return ShearFlow(twist=twist, relaxation=relaxation, warping=warping)


def strain_rows(points: WallPoints, flow: ShearFlow, thickness: Array, shear: str) -> Array:
    """(S, P, 6, 9): wall strains (ε0, ε1, ε3, γ0, γ1, γ2) per generalised strain."""
    x, y, l, m = points.x, points.y, points.l, points.m  # noqa: E741
    rows = np.zeros((*x.shape, 6, 9))
    rows[..., 0, W], rows[..., 0, TX], rows[..., 0, TY], rows[..., 0, PHI2] = 1.0, y, -x, -flow.warping
    rows[..., 1, TX], rows[..., 1, TY], rows[..., 1, PHI2] = m, -l, -points.tangential_distance
    rows[..., 3, [W, TX, TY, PHI2]] = flow.relaxation
    rows[..., 3, PHI] = flow.twist
    rows[..., 4, PHI] = 2.0
    if shear != "rigid":
        rows[..., 3, GX], rows[..., 3, GY] = -m, l
    if shear == "higher_order":
        cubic, quadratic = 4.0 / (3.0 * thickness**2), -4.0 / thickness**2
        rows[..., 2, TX], rows[..., 2, VV] = -cubic * m, -cubic * m
        rows[..., 2, TY], rows[..., 2, UU] = cubic * l, -cubic * l
        rows[..., 5, GX], rows[..., 5, GY] = -quadratic * m, quadratic * l
    return rows


def transverse_shear_rows(points: WallPoints) -> Array:
    """(S, P, 9): γ_nz at the mid-line per generalised strain."""
    rows = np.zeros((*points.x.shape, 9))
    rows[..., GX], rows[..., GY] = points.l, points.m
    return rows


def transverse_shear_stiffness(laws: LawTable, shear: str) -> Array:
    """∫ Q̄44 g² dn (S, P), N/m, with g = 1 − 4n²/h² in the higher-order theory and 1 otherwise."""
    moments = laws.transverse_shear
    if shear != "higher_order":
        return moments[..., 0]
    inverse = 4.0 / laws.thickness**2
    return moments[..., 0] - 2.0 * inverse * moments[..., 2] + inverse**2 * moments[..., 4]


@dataclass(frozen=True, slots=True, eq=False)
class PointMotion:
    """Displacement of a wall point at depth n as a polynomial in n: coefficients (S, P, powers, 9) per generalised displacement."""

    lag: Array
    flap: Array
    span: Array

    powers = (0, 1, 3)


def motion_rows(points: WallPoints, flow: ShearFlow, thickness: Array, shear: str) -> PointMotion:
    """U, V, W of the wall points, each with its n⁰, n¹ and n³ coefficients."""
    x, y, l, m = points.x, points.y, points.l, points.m  # noqa: E741
    lag, flap, span = (np.zeros((*x.shape, 3, 9)) for _ in range(3))
    lag[..., 0, DU], lag[..., 0, DPHI], lag[..., 1, DPHI] = 1.0, -y, -m
    flap[..., 0, DV], flap[..., 0, DPHI], flap[..., 1, DPHI] = 1.0, x, l
    span[..., 0, DS], span[..., 0, DTX], span[..., 0, DTY], span[..., 0, DPHI1] = 1.0, y, -x, -flow.warping
    span[..., 1, DTX], span[..., 1, DTY], span[..., 1, DPHI1] = m, -l, -points.tangential_distance
    if shear == "higher_order":
        cubic = 4.0 / (3.0 * thickness**2)
        span[..., 2, DTY], span[..., 2, DU1] = cubic * l, -cubic * l
        span[..., 2, DTX], span[..., 2, DV1] = -cubic * m, -cubic * m
    return PointMotion(lag, flap, span)
