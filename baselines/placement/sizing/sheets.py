"""Sheets that patches are cut from, of any width and thickness, and functions of the two by their values at a few sizes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.patches import PatchGroup, PatchMaterial

Array = NDArray[np.float64]

Span = tuple[float, float]


def cut_to(material: PatchMaterial, thickness: float) -> PatchMaterial:
    """The sheet in another thickness (m), across which its field runs if it did; an MFC's runs between its fingers."""
    spacing = thickness if through_thickness(material) else material.electrode_spacing
    return replace(material, thickness=thickness, electrode_spacing=spacing)


def through_thickness(material: PatchMaterial) -> bool:
    """Whether a sheet is driven across its thickness, by a field that goes down as it gets thicker."""
    return material.electrode_spacing == material.thickness


def of_size(group: PatchGroup, width: float, thickness: float) -> PatchGroup:
    """The group with patches of another width and thickness, m."""
    material = group.material if thickness == group.patch.thickness else cut_to(group.patch, thickness)
    return replace(group, width=width, material=material)


def with_sheets(config: BladeConfig, sizes: Sequence[float]) -> BladeConfig:
    """The blade with sheets of (width, thickness) of the actuators and of the sensors, m."""
    above, below = config.patches.pair()
    actuators, sensors = (of_size(above, *sizes[:2]),), (of_size(below, *sizes[2:]),)
    return replace(config, patches=replace(config.patches, actuators=actuators, sensors=sensors))


@dataclass(frozen=True, slots=True)
class SizeGrid:
    """Widths times thicknesses at which something is known, J of them, and the polynomials that it is in between."""

    width: Span
    """m."""
    thickness: Span
    """m."""
    counts: tuple[int, int]
    """Nodes in each of the two."""

    @property
    def nodes(self) -> Array:
        """(J, 2): width and thickness, m, width slowest."""
        axes = (_nodes(*each) for each in zip((self.width, self.thickness), self._counts, strict=True))
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)

    @property
    def _counts(self) -> tuple[int, ...]:
        """One where there is no range."""
        return tuple(n if high > low else 1 for n, (low, high) in zip(self.counts, (self.width, self.thickness), strict=True))

    def weights(self, sizes: Array) -> Array:
        """(N, J) by which values at the nodes are to be summed for sizes (N, 2), m."""
        in_width, in_thickness = (each[0] for each in self._by_axis(sizes))
        return _outer(in_width, in_thickness)

    def weight_slopes(self, sizes: Array) -> Array:
        """(N, 2, J): derivatives of ``weights`` by width and by thickness, 1/m."""
        (in_width, by_width), (in_thickness, by_thickness) = self._by_axis(sizes)
        return np.stack([_outer(by_width, in_thickness), _outer(in_width, by_thickness)], axis=1)

    def _by_axis(self, sizes: Array) -> list[tuple[Array, Array]]:
        spans = (self.width, self.thickness)
        return [_lagrange(span, n, sizes[:, k]) for k, (span, n) in enumerate(zip(spans, self._counts, strict=True))]


def _outer(first: Array, second: Array) -> Array:
    return np.asarray((first[:, :, None] * second[:, None, :]).reshape(len(first), -1))


def _nodes(span: Span, count: int) -> Array:
    middle, half = 0.5 * (span[1] + span[0]), 0.5 * (span[1] - span[0])
    return middle + half * chebyshev.chebpts1(count)


def _lagrange(span: Span, count: int, at: Array) -> tuple[Array, Array]:
    """Lagrange's polynomials of Chebyshev's nodes (N, count), and their slopes."""
    half = max(0.5 * (span[1] - span[0]), np.finfo(float).tiny)
    x = (at - 0.5 * (span[1] + span[0])) / half if count > 1 else np.zeros(len(at))
    to_nodes = np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(count), count - 1))
    slopes = chebyshev.chebder(np.eye(count), axis=0) if count > 1 else np.zeros((1, 1))
    by_slope = chebyshev.chebvander(x, len(slopes) - 1) @ slopes / half if count > 1 else np.zeros((len(at), 1))
    return chebyshev.chebvander(x, count - 1) @ to_nodes, by_slope @ to_nodes
