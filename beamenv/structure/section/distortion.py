"""How a section distorts in its own plane: the slowest vibrations of a section that is the same all along an endless beam.

Saint-Venant's solutions hold for loads at the ends. Where stress resultants change along the span, and more so in the higher modes,
a section also distorts; it can be seen against solid elements from the second torsion mode on.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.section.central_solution import Factorised, mean_motion, without
from beamenv.structure.section.elements import RIGID, coefficients_through_wall

Array = NDArray[np.float64]

DISTORTIONS = 2
"""Shapes that a section may take beside Saint-Venant's: with them the first eleven modes of the thesis' blade are within 1.4 % of
solid elements; with none its second torsion mode is 9 % too high. Slower shapes still bulge the walls like a plate's anticlastic
bending, which Saint-Venant's shapes already do; they bring no frequency nearer, but a tip's deflection per volt 2 to 5 % off, since
a force that acts on the mean motion of the mass raises them over the whole span."""

ROUNDS = 1
"""Of subspace iteration: from polynomials, one leaves no frequency of a blade more than 3e-6 off."""

TOLD_APART = 1e-12
"""Least energy of a mixture of shapes, of unit energy each, that is more than rounding."""


def distortion_shapes(system: Factorised, loads: Array) -> Array:
    """(V, lines, 12, DISTORTIONS) of unit energy, ½ for half a unit, in the section that the loads are those of the vibrations of.

    All sections take the same loads, so that the same coefficient means the same shape in all.
    """
    return _under(system, np.broadcast_to(loads, (len(system.factors), *loads.shape[1:])))


def loads_of_vibrations(system: Factorised) -> Array:
    """Inertial loads on the elements (1, K, size, DISTORTIONS) that give one section its slowest shapes, of unit energy."""
    sums = system.sums
    shapes = without(sums, trial := _polynomials(sums.nodes), mean_motion(sums, trial))
    for _ in range(ROUNDS):
        loads = sums.inertial(sums.gather(shapes))
        shapes = _under(system, loads)
        here = sums.gather(shapes)
        energy = (here.swapaxes(-1, -2) @ loads).sum(axis=1)[0]
        mass = (here.swapaxes(-1, -2) @ sums.inertial(here)).sum(axis=1)[0]
        squares, vectors = _slowest(0.5 * (mass + mass.T), 0.5 * (energy + energy.T))
        shapes = shapes @ vectors
    slowest = shapes[..., :DISTORTIONS] / squares[:DISTORTIONS]
    return np.asarray(sums.inertial(sums.gather(slowest)))


def loads_of_bimoment(system: Factorised, torsion: Array) -> Array:
    """Loads on the elements (1, K, size, 1) that contract one section as the stresses of warping held back do, of unit energy; of
    none, (1, K, size, 0), where ν = 0 leaves nothing to contract.

    ``torsion`` (1, lines, 12, 1) is its warping in torsion. An open section bears torsion by these stresses; were it not free to
    contract across them, it would be stiffer by (1 − ν)/(1 + ν)(1 − 2ν), a third for ν = 0.3.
    """
    sums = system.sums
    held = sums.gather(torsion)
    loads = -sums.cross @ held
    shape = sums.gather(_under(system, loads))
    energy = (shape.swapaxes(-1, -2) @ loads).sum(axis=1)
    if not np.all(energy > TOLD_APART * sums.energy(np.zeros_like(held), held, np.zeros((1, RIGID, 1)))):
        return loads[..., :0]
    return np.asarray(loads / np.sqrt(energy)[:, None])


def _slowest(mass: Array, energy: Array) -> tuple[Array, Array]:
    """1/ω², descending, of mixtures of shapes, and the mixtures (c, d), of unit energy; none that only rounding tells apart.

    All shapes are drawn towards the slowest vibrations, the more so the thinner the walls.
    """
    unit = 1.0 / np.sqrt(np.diagonal(energy))
    share, apart = np.linalg.eigh(energy * np.outer(unit, unit))
    kept = share > TOLD_APART * share[-1]
    mixed = unit[:, None] * apart[:, kept] / np.sqrt(share[kept])
    squares, vectors = np.linalg.eigh(mixed.T @ mass @ mixed)
    return squares[::-1], mixed @ vectors[:, ::-1]


def _under(system: Factorised, loads: Array) -> Array:
    """Shapes (V, lines, 12, c) under loads on elements (V, K, size, c), without stress resultants."""
    shapes, _ = system.solve(loads, np.zeros((len(loads), 6, loads.shape[-1])))
    return without(system.sums, shapes, mean_motion(system.sums, shapes))


def _polynomials(nodes: Array) -> Array:
    """(V, lines, 12, 14): displacements along x and y that are quadratic and cubic in the place."""
    scale = np.abs(nodes).max(axis=(1, 2), keepdims=True)
    x, y = np.moveaxis(nodes / scale, -1, 0)
    monomials = np.stack([x * x, x * y, y * y, x**3, x * x * y, x * y * y, y**3], axis=-1)
    moved = np.zeros((*x.shape, 3, 2, monomials.shape[-1]))
    moved[..., 0, 0, :] = moved[..., 1, 1, :] = monomials
    return coefficients_through_wall(moved.reshape(*x.shape, -1)).reshape(*x.shape[:2], -1, 2 * monomials.shape[-1])
