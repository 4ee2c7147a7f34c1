"""Layouts of patches of several sizes as matrices, and their exact derivatives by every edge, width and thickness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.contributions import BELOW, BOTH, TOP
from baselines.placement.model.intervals import Intervals
from baselines.placement.model.layout_model import LayoutMatrices, MatrixSlopes
from baselines.placement.model.triangles import skew_from, symmetric_from
from baselines.placement.sizing.sized_contributions import SizedContributions

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Weights:
    """By which series at J sizes are summed, of N layouts, or their derivatives by the four sizes of one layout."""

    above: Array
    """(N, J): of the actuators' sheets."""
    below: Array
    """(N, J): of the sensors'."""
    together: Array
    """(N,): of what both have together."""
    force_together: Array
    charge_together: Array
    """(N,): of what a sensor changes of an actuator's force, and the other way round."""


def weights_of(parts: SizedContributions, sizes: Array) -> Weights:
    """Of sizes (N, 4), m."""
    share = sizes / parts.sizes
    above, below = (grid.weights(pair) for grid, pair in zip(parts.grids, np.split(sizes, 2, axis=1), strict=True))
    return Weights(above, below, share.prod(axis=1), share.prod(axis=1), share[:, [0, 1, 2]].prod(axis=1))


def weight_slopes(parts: SizedContributions, sizes: Array) -> Weights:
    """Derivatives, 1/m, of one layout's weights by its sizes (4,); N is 4."""
    of = [grid.weight_slopes(pair[None])[0] for grid, pair in zip(parts.grids, np.split(sizes, 2), strict=True)]
    above, below = (np.zeros((4, each.shape[1])) for each in of)
    above[:2], below[2:] = of
    share = sizes / parts.sizes

    def product_slopes(which: list[int]) -> Array:
        found = np.zeros(4)
        for k in which:
            found[k] = np.prod([share[other] for other in which if other != k]) / parts.sizes[k]
        return found

    every = product_slopes([0, 1, 2, 3])
    return Weights(above, below, every, every, product_slopes([0, 1, 2]))


def sized_matrices(parts: SizedContributions, cut: Intervals, weights: Weights, passive: bool, weight: float) -> LayoutMatrices:
    """Blades with patches that cut them so; ``weight`` is of every unit of drive squared, J."""
    n = len(parts.middle.bare_frequencies)
    stiffness = np.eye(n)[None]
    mass, gyroscopic = np.diag(parts.middle.bare_frequencies**-2.0)[None], parts.middle.bare_gyroscopic[None]
    if passive:
        shares = by_sizes(by_kind(cut.share(), 3), weights)
        pulled = by_kind(cut.pulled_share(tension_of(parts, weights)), 4)
        stiffness = stiffness + symmetric_from(shares @ parts.stiffness + tightened(pulled, weights) @ parts.tightening, n)
        mass = mass + symmetric_from(shares @ parts.mass, n)
        gyroscopic = gyroscopic + skew_from(shares @ parts.gyroscopic, n)
    top, below = cut.patches.force_shares()
    return LayoutMatrices(
        stiffness=stiffness,
        mass=mass,
        gyroscopic=gyroscopic,
        forces=forces(parts, weights, top).swapaxes(1, 2),
        charges=charges(parts, weights, below),
        stored_energy=weight * np.eye(top.shape[1])[None],
    )


def sized_slopes(parts: SizedContributions, cut: Intervals, weights: Weights, slopes: Weights, passive: bool) -> MatrixSlopes:
    """Derivatives of one layout's matrices: by the E starts, the E other edges, and the four sizes, per m."""
    n, edges = len(parts.middle.bare_frequencies), cut.patches
    at_edges = edges.slopes()
    top, below = (each[0] for each in edges.force_share_slopes(at_edges))
    own_top, own_below = edges.force_shares()
    count, four = len(top), np.zeros(4, dtype=int)
    stiffness = mass = gyroscopic = np.zeros((count + 4, n, n))
    if passive:
        by_edge = by_sizes(by_kind(cut.share_slopes(at_edges)[0], 3), weights)
        by_size = by_sizes(by_kind(cut.share()[four], 3), slopes)
        shares = np.concatenate([by_edge, by_size])
        pulled = tightened_slopes(parts, cut, at_edges, weights, slopes)
        stiffness = symmetric_from(shares @ parts.stiffness + pulled @ parts.tightening, n)
        mass, gyroscopic = symmetric_from(shares @ parts.mass, n), skew_from(shares @ parts.gyroscopic, n)
    force = np.concatenate([forces(parts, weights, top), forces(parts, slopes, own_top[four])])
    charge = np.concatenate([charges(parts, weights, below), charges(parts, slopes, own_below[four])])
    channels = own_top.shape[1]
    return MatrixSlopes(stiffness, mass, gyroscopic, force.swapaxes(1, 2), charge, np.zeros((count + 4, channels, channels)))


def by_kind(shares: Array, kinds: int) -> Array:
    """(N, kinds, k)."""
    return shares.reshape(len(shares), kinds, -1)


def by_sizes(shares: Array, weights: Weights) -> Array:
    """(N, (2J + 1) k) from shares (N, 3, k) of sections covered on top, below and on both."""
    top, below, both = (shares[:, kind - 1] for kind in (TOP, BELOW, BOTH))
    parts = [
        weights.above[:, :, None] * (top + both)[:, None],
        weights.below[:, :, None] * (below + both)[:, None],
        weights.together[:, None, None] * both[:, None],
    ]
    return np.concatenate([each.reshape(len(each), -1) for each in parts], axis=1)


def tightened(pulled: Array, weights: Weights) -> Array:
    """(N, k + (2J + 1) k) from shares (N, 4, k) of every kind, each times what pulls it."""
    return np.concatenate([pulled.sum(axis=1), by_sizes(pulled[:, 1:], weights)], axis=1)


def tightened_slopes(parts: SizedContributions, cut: Intervals, at_edges: Array, weights: Weights, slopes: Weights) -> Array:
    """Derivatives of one layout's ``tightened``: sizes change what pulls, and the sections that are pulled."""
    tension = tension_of(parts, weights)
    by_edge = tightened(by_kind(cut.pulled_share_slopes(tension, at_edges)[0], 4), weights)
    sections = by_kind(cut.pulled_share(tension), 4)
    changed = by_sizes(sections[np.zeros(4, dtype=int), 1:], slopes)
    pulls = tension_of(parts, slopes)
    pulled = np.concatenate([tightened(by_kind(cut.pulled_share(each[None]), 4), weights) for each in pulls])
    pulled[:, cut.patches.span.count :] += changed
    return np.concatenate([by_edge, pulled])


def tension_of(parts: SizedContributions, weights: Weights) -> Array:
    """h(z) (N, k, 4) of every kind of section: masses of both walls add up."""
    above, below = weights.above @ parts.tension[0], weights.below @ parts.tension[1]
    return np.stack([np.zeros_like(above), above, below, above + below], axis=-1)


def forces(parts: SizedContributions, weights: Weights, shares: Array) -> Array:
    """(N, a, n) per unit of drive, from shares (N, a, 2, k)."""
    own = np.einsum("nak,nj,jkm->nam", shares[:, :, 0], weights.above, parts.forces, optimize=True)
    together = weights.force_together[:, None, None] * shares[:, :, 1] @ parts.middle.actuator_force[1]
    return np.asarray(own + together)


def charges(parts: SizedContributions, weights: Weights, shares: Array) -> Array:
    """(N, s, n) per coordinate, likewise."""
    own = np.einsum("nak,nj,jkm->nam", shares[:, :, 0], weights.below, parts.charges, optimize=True)
    together = weights.charge_together[:, None, None] * shares[:, :, 1] @ parts.middle.sensor_force[1]
    return np.asarray(own + together)
