"""Integrals over layers of elements, of what their shapes do alone: the blades of a bank share them, whatever their plies are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed
from beamenv.structure.section.elements import ACROSS, places
from beamenv.structure.section.mesh import Mesh
from beamenv.structure.stations import gauss_rule

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

Rule = tuple[tuple[float, ...], tuple[float, ...]]
"""Places from −1 at the bottom of a layer to 1 at its top, and weights: of something that changes through it."""

MONOMIALS = 6
"""1, x, y, x², xy, y²."""

FEW = 100
"""Elements of a layer whose integrals are remembered, some 20 kB each: the sections of a tapered blade have more."""

REMEMBERED = 32
"""Layers."""


@dataclass(frozen=True, slots=True, eq=False)
class Integrals(Sealed):
    """Over one layer of E elements of N shapes; tables are ``Places.tables``: slopes along x and y, around z, and values."""

    square: Array
    """Of the products of all pairs of tables (E, 16, N, N)."""
    values: Array
    """Of those with values (E, 4, N, N)."""
    value: Array
    """Of values with values (E, N, N)."""
    with_beam: Array
    """Of tables with 1, x and y (E, 12, N, 1)."""
    value_with_beam: Array
    """Of values with 1, x and y (E, 3, N, 1)."""
    of_beam: Array
    """Of 1, x and y with one another (E, 9, 1, 1)."""
    moments: Array
    """Of tables with all monomials (E, 4, 6 N, 1)."""
    moments_of_value: Array
    """Of values with them (E, 1, 6 N, 1)."""
    moments_of_beam: Array
    """Of 1, x and y with them (E, 3, 6, 1)."""
    area: Array
    """Of the monomials (E, 6)."""

    @classmethod
    def of(cls, mesh: Mesh, elements: Indices, low: float, high: float, rule: Rule | None) -> Integrals:
        """By Gauss's rule, of few points through thin layers, or by one of a weight through the layer."""
        along, weight_along = gauss_rule(mesh.order + 1)
        thickness = mesh.thickness[elements[0] % len(mesh.edges)]
        usual = gauss_rule(ACROSS + 1 if high - low > 0.4 * thickness else 2)
        depth, weight = usual if rule is None else np.array(rule)
        half = 0.5 * (high - low)
        here = places(mesh, elements, along, low + half * (1.0 + depth), weight_along, half * weight)
        tables = here.tables()
        nodes, count = here.value.shape[-1], len(elements)
        pairs = (tables * here.weight[..., None]).swapaxes(-1, -2) @ tables
        shapes = pairs[:, : 4 * nodes, : 4 * nodes].reshape(count, 4, nodes, 4, nodes)
        with_beam = pairs[:, : 4 * nodes, 4 * nodes :].reshape(count, 4, nodes, 3)
        by_pair = with_beam.transpose(0, 1, 3, 2)[..., None]
        monomials = np.stack([np.ones_like(here.x), here.x, here.y, here.x**2, here.x * here.y, here.y**2], axis=1)
        weighted = monomials * here.weight[:, None]
        sums = weighted @ tables
        of_shapes = sums[..., : 4 * nodes].reshape(count, MONOMIALS, 4, nodes).transpose(0, 2, 1, 3)
        return cls(
            square=shapes.transpose(0, 1, 3, 2, 4).reshape(count, 16, nodes, nodes),
            values=shapes[:, :, :, 3],
            value=shapes[:, 3, :, 3],
            with_beam=by_pair.reshape(count, 12, nodes, 1),
            value_with_beam=by_pair[:, 3],
            of_beam=pairs[:, 4 * nodes :, 4 * nodes :].reshape(count, 9, 1, 1),
            moments=of_shapes.reshape(count, 4, -1, 1),
            moments_of_value=of_shapes[:, 3].reshape(count, 1, -1, 1),
            moments_of_beam=sums[..., 4 * nodes :].transpose(0, 2, 1)[..., None],
            area=weighted.sum(axis=-1),
        )


def integrals(mesh: Mesh, elements: Indices, low: float, high: float, rule: Rule | None = None) -> Integrals:
    """Over a layer from ``low`` to ``high`` (m from the mid-line) of elements (flat indices into the mesh)."""
    if len(elements) > FEW:
        return Integrals.of(mesh, elements, low, high, rule)
    return _remembered(mesh, elements.tobytes(), low, high, rule)


@lru_cache(maxsize=REMEMBERED)
def _remembered(mesh: Mesh, elements: bytes, low: float, high: float, rule: Rule | None) -> Integrals:
    return Integrals.of(mesh, np.frombuffer(elements, dtype=np.intp), low, high, rule)
