"""A clamped plate with sheets by finite elements of its own: Kirchhoff's plate, stretched too, and no beam anywhere."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

NODES, WEIGHTS = (each / 2.0 for each in np.polynomial.legendre.leggauss(4))
NODES = NODES + 0.5


def isotropic(modulus, ratio):
    """(3, 3) of plane stress, Pa, in (along, across, shear)."""
    return modulus / (1.0 - ratio**2) * np.array([[1.0, ratio, 0.0], [ratio, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - ratio)]])


@dataclass(frozen=True)
class Sheet:
    """On the face 1 (upper) or −1 of a plate, in the middle of its width: (3, 3) Pa, kg/m³, m, and m/V if it is driven."""

    start: float
    length: float
    width: float
    thickness: float
    stiffness: np.ndarray
    density: float
    free: float = 0.0
    face: int = 1
    passive: bool = True


@dataclass(frozen=True)
class Plate:
    """Thickness in m, (3, 3) Pa, kg/m³; lines of the grid along and across in m, at which sheets begin and end."""

    thickness: float
    stiffness: np.ndarray
    density: float
    along: np.ndarray
    across: np.ndarray
    sheets: tuple[Sheet, ...]

    def law(self, x, y):
        """(6, 6) of resultants over strains and curvatures, kg/m², and (6,) resultants per volt, at a point."""
        h = self.thickness
        layers = [(self.stiffness, self.density, h, 0.0, 0.0, True)]
        for each in self.sheets:
            if each.start < x < each.start + each.length and abs(y) < 0.5 * each.width:
                arm = 0.5 * each.face * (h + each.thickness)
                layers.append((each.stiffness, each.density, each.thickness, arm, each.free, each.passive))
        law, mass, drive = np.zeros((6, 6)), 0.0, np.zeros(6)
        for stiffness, density, t, arm, free, passive in layers:
            pull = stiffness @ np.array([free, free, 0.0])
            drive += np.concatenate([pull, arm * pull])
            if passive:
                law += np.kron(np.array([[t, t * arm], [t * arm, t * arm**2 + t**3 / 12.0]]), stiffness)
                mass += density * t
        return law, mass, drive

    def assembled(self):
        """Stiffness, mass and force per volt of the free unknowns, and which of them is the middle of the tip."""
        nx, ny = len(self.along) - 1, len(self.across) - 1
        flat, bent = (2 * nx + 1) * (2 * ny + 1), 4 * (nx + 1) * (ny + 1)
        places, stiff, heavy, force = [], [], [], np.zeros(bent + 2 * flat)
        for i in range(nx):
            for j in range(ny):
                corner, size = (self.along[i], self.across[j]), (np.diff(self.along)[i], np.diff(self.across)[j])
                law, mass, drive = self.law(corner[0] + 0.5 * size[0], corner[1] + 0.5 * size[1])
                stretched = [(2 * i + p) * (2 * ny + 1) + 2 * j + q for p in range(3) for q in range(3)]
                deflected = [4 * ((i + p // 2) * (ny + 1) + j + q // 2) + 2 * (p % 2) + q % 2 for p in range(4) for q in range(4)]
                places.append(np.concatenate([bent + np.array(stretched), bent + flat + np.array(stretched), deflected]))
                strain, moved = shapes(*size)
                weights = AREA * size[0] * size[1]
                stiff.append(np.tensordot(strain, weights * (law @ strain), ((0, 1), (0, 1))))
                heavy.append(np.tensordot(moved, weights * mass * moved, ((0, 1), (0, 1))))
                np.add.at(force, places[-1], drive @ (weights * strain).sum(axis=0))
        rows, columns = (np.concatenate([grid.ravel() for grid in grids]) for grids in zip(*map(pairs, places), strict=True))
        held = np.concatenate([np.arange(4 * (ny + 1)), bent + np.arange(2 * ny + 1), bent + flat + np.arange(2 * ny + 1)])
        free = np.setdiff1d(np.arange(len(force)), held)
        K, M = (csc_matrix((np.ravel(each), (rows, columns)))[free][:, free] for each in (stiff, heavy))
        return K, M, force[free], np.searchsorted(free, 4 * (nx * (ny + 1) + ny // 2))

    def solved(self):
        """m at the tip per volt, Hz of the first mode, and m at the tip per volt in it."""
        K, M, force, tip = self.assembled()
        solver, mode = splu(K), np.random.default_rng(0).normal(size=len(force))
        for _ in range(8):  # the second mode falls by 36 each time
            mode = solver.solve(M @ mode)
            mode /= np.sqrt(mode @ (M @ mode))
        square = mode @ (K @ mode)
        return solver.solve(force)[tip], np.sqrt(square) / (2.0 * np.pi), mode[tip] * (mode @ force) / square


AREA = np.outer(WEIGHTS, WEIGHTS).reshape(-1, 1, 1)


def pairs(places):
    return np.meshgrid(places, places, indexing="ij")


def hermite(size):
    """(3, 4, 4): Hermite's cubics, their first and second derivatives, of each at each of Gauss' points."""
    s, one = NODES, np.ones(len(NODES))
    return np.array(
        [
            [1 - 3 * s**2 + 2 * s**3, size * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, size * (s**3 - s**2)],
            [(6 * s**2 - 6 * s) / size, 1 - 4 * s + 3 * s**2, (6 * s - 6 * s**2) / size, 3 * s**2 - 2 * s],
            [(12 * s - 6 * one) / size**2, (6 * s - 4 * one) / size, (6 * one - 12 * s) / size**2, (6 * s - 2 * one) / size],
        ]
    )


def lagrange(size):
    """(2, 3, 4): quadratics and their derivatives, likewise."""
    s = NODES
    return np.array(
        [[(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], [*(np.array([4 * s - 3, 4 - 8 * s, 4 * s - 1]) / size)]]
    )


def shapes(long, wide):
    """Strains and curvatures (points, 6, 34), and displacements (points, 3, 34), of the unknowns of an element."""

    def product(first, second):
        return np.einsum("ag,bh->ghab", first, second).reshape(16, -1)

    X, Y, P, Q = hermite(long), hermite(wide), lagrange(long), lagrange(wide)
    strain, moved = np.zeros((16, 6, 34)), np.zeros((16, 3, 34))
    strain[:, 0, :9] = strain[:, 2, 9:18] = product(P[1], Q[0])
    strain[:, 1, 9:18] = strain[:, 2, :9] = product(P[0], Q[1])
    for row, (p, q), factor in ((3, (2, 0), -1.0), (4, (0, 2), -1.0), (5, (1, 1), -2.0)):
        strain[:, row, 18:] = factor * product(X[p], Y[q])
    moved[:, 0, :9] = moved[:, 1, 9:18] = product(P[0], Q[0])
    moved[:, 2, 18:] = product(X[0], Y[0])
    return strain, moved


def grid(edges, counts):
    """Lines between edges, so many elements from each to the next."""
    return np.unique(
        np.concatenate([np.linspace(a, b, n + 1) for a, b, n in zip(edges[:-1], edges[1:], counts, strict=True)]).round(9)
    )
