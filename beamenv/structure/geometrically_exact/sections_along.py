"""The sections of a blade along its span: solid sections at few sizes and with every combination of inlays, and between them."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed, sealed_property
from beamenv.structure.geometrically_exact.rotations import about_span
from beamenv.structure.section.mesh import mesh
from beamenv.structure.section.section import Section
from beamenv.structure.section.solid_sections import SolidSections
from beamenv.structure.walls.inlay import Inlay, Strip
from beamenv.structure.walls.laminate import Laminate, Layup

Array = NDArray[np.float64]

SIZES = 9
"""Sizes at which the sections of a tapered blade are worked out; between them its properties, smooth functions of the size, follow
a polynomial."""


@dataclass(frozen=True, slots=True)
class Planform:
    """How the section is turned and scaled along the span."""

    length: float
    pretwist: float
    presetting: float
    """rad, of the whole span and of the root."""
    taper: float

    def scale(self, z: Array) -> Array:
        """Size over that of the root (S,)."""
        tip = 1.0 / self.taper
        return tip + (1.0 - tip) * (1.0 - z / self.length)

    def frames(self, z: Array) -> Array:
        """C₀ (S, 3, 3): the axes of the sections."""
        return about_span(self.presetting + self.pretwist * z / self.length)

    @property
    def rate(self) -> float:
        """rad/m."""
        return self.pretwist / self.length

    @property
    def sizes(self) -> Array:
        """Chebyshev points from the size of the root to that of the tip, both included; one for a blade without taper."""
        if self.taper == 1.0:
            return np.ones(1)
        nodes = np.cos(np.pi * np.arange(SIZES) / (SIZES - 1))
        tip = 1.0 / self.taper
        return 0.5 * (1.0 + tip) + 0.5 * (1.0 - tip) * nodes


NOTHING = 1e-9
"""Energy, over that of one strain alone, that rounding may take."""


@dataclass(frozen=True, eq=False)
class SectionsAlong(Sealed):
    """Every section that a blade has, and which is where."""

    section: Section
    layup: Layup
    planform: Planform
    inlays: tuple[Inlay, ...]
    kinds: tuple[Inlay, ...]
    """One inlay of each kind."""
    codes: NDArray[np.intp]
    """(C,) ascending: which combinations of kinds occur, as sums of powers of two."""
    solid: SolidSections
    """C times SIZES of them (or one), combination after combination."""

    @classmethod
    def build(
        cls, section: Section, layup: Layup, planform: Planform, inlays: Sequence[Inlay], cuts: Sequence[Strip] = ()
    ) -> SectionsAlong:
        """Those of a blade whose inlays may lie anywhere."""
        kinds = _kinds(inlays)
        codes = _combinations(inlays, kinds)
        strips = tuple(sorted({*cuts, *(inlay.strip for inlay in inlays)}, key=lambda each: (each.wall, each.width, each.offset)))
        hosts = section.hosts(layup)
        sheets = tuple(kind.kind for kind in kinds)
        key = (section, tuple(hosts.items()), sheets, codes.tobytes(), strips, planform.rate, planform.taper)
        solid = _ALIVE.get(key)
        if solid is None:
            solid = _ALIVE[key] = _solid_sections(section, hosts, planform, kinds, codes, strips)
        return cls(section, layup, planform, tuple(inlays), kinds, codes, solid)

    def cut_for(self, strip: Strip) -> SectionsAlong:
        """The same sections, with a wall's elements cut where a strip begins and ends."""
        cut = SectionsAlong.build(self.section, self.layup, self.planform, self.inlays, [strip])
        return replace(cut, solid=cut.solid.aligned(self.solid))

    def at(self, z: Array, values: Array) -> Array:
        """(S, …): what the sections have (V, …), at stations z (m)."""
        code = np.zeros(len(z), dtype=np.intp)
        for bit, kind in enumerate(self.kinds):
            covered = np.any([inlay.covers(z) for inlay in self.inlays if inlay.kind == kind.kind], axis=0)
            code += covered.astype(np.intp) << bit
        return self._of(np.searchsorted(self.codes, code), z, values)

    def under(self, code: int, z: Array, values: Array) -> Array:
        """(S, …): what the sections have (V, …), at stations z (m), were the inlays there those of a combination's code."""
        return self._of(np.full(len(z), np.searchsorted(self.codes, code)), z, values)

    def _of(self, which: NDArray[np.intp], z: Array, values: Array) -> Array:
        sizes = self.planform.sizes
        if len(sizes) == 1:
            return values[which]
        by_size = values.reshape(len(self.codes), len(sizes), *values.shape[1:])[which]
        return np.einsum("sn,sn...->s...", self._weights(self.planform.scale(z)), by_size)

    def _weights(self, scale: Array) -> Array:
        """(S, SIZES): of the sizes known, for sections of other sizes."""
        sizes = self.planform.sizes
        if self._smooth:
            return between(sizes, scale)
        order = np.argsort(sizes)
        return np.stack([np.interp(scale, sizes[order], row[order]) for row in np.eye(len(sizes))], axis=-1)

    @sealed_property
    def _smooth(self) -> bool:
        """Whether the polynomial between sizes leaves every section some energy in every strain. That of very thin walls under
        strong pretwist, which warp otherwise at every size, may not; then the mean of two neighbours does.
        """
        sizes = self.planform.sizes
        halfway = between(sizes, np.linspace(sizes.min(), sizes.max(), 4 * len(sizes)))
        energy = self.solid.energy.reshape(len(self.codes), len(sizes), -1)
        size = self.solid.energy.shape[-1]
        unit = 1.0 / np.sqrt(np.diagonal(self.solid.energy[0]))
        every = np.einsum("sn,cne->cse", halfway, energy).reshape(-1, size, size) * np.outer(unit, unit)
        return bool(np.linalg.eigvalsh(every).min() > -NOTHING)


_ALIVE: WeakValueDictionary[Hashable, SolidSections] = WeakValueDictionary()
"""Sections that some blade has: an equal one shares them, for they cannot be changed. They do not depend on the speed, on where
patches are, or on how many terms there are."""


def _solid_sections(
    section: Section,
    hosts: Mapping[str, Laminate],
    planform: Planform,
    kinds: Sequence[Inlay],
    codes: NDArray[np.intp],
    strips: Sequence[Strip],
) -> SolidSections:
    sizes = planform.sizes
    elements = mesh(section.placed_chains, np.tile(sizes, len(codes)), strips)
    laminates = dict[Laminate, int]()
    which = np.empty((len(codes), len(elements.edges)), dtype=np.intp)
    for row, code in enumerate(codes.tolist()):
        for k, edge in enumerate(elements.edges):
            laminate = hosts[edge.wall]
            for bit, kind in enumerate(kinds):
                if code >> bit & 1 and edge.lies_under(kind):
                    laminate = kind.let_into(laminate)
            which[row, k] = laminates.setdefault(laminate, len(laminates))
    return SolidSections.build(elements, list(laminates), np.repeat(which, len(sizes), axis=0), planform.rate)


def between(nodes: Array, at: Array) -> Array:
    """(S, n): the polynomial through n nodes, at S places; Lagrange's form."""
    apart = nodes[:, None] - nodes + np.eye(len(nodes))
    distance = at[:, None, None] - nodes[None, None, :] * np.ones((1, len(nodes), 1))
    factors = np.where(np.eye(len(nodes), dtype=bool), 1.0, distance / apart)
    return np.asarray(factors.prod(axis=2))


def _kinds(inlays: Sequence[Inlay]) -> tuple[Inlay, ...]:
    found: list[Inlay] = []
    for inlay in inlays:
        if not any(inlay.kind == kind.kind for kind in found):
            found.append(inlay)
    return tuple(found)


def _combinations(inlays: Sequence[Inlay], kinds: Sequence[Inlay]) -> NDArray[np.intp]:
    """The codes of all combinations of kinds that lie over one another somewhere, the bare section first."""
    edges = np.unique([edge for inlay in inlays for edge in (inlay.start, inlay.start + inlay.length)])
    middles = 0.5 * (edges[1:] + edges[:-1])
    code = np.zeros(len(middles), dtype=np.intp)
    for bit, kind in enumerate(kinds):
        for inlay in inlays:
            if inlay.kind == kind.kind:
                code |= inlay.covers(middles).astype(np.intp) << bit
    return np.unique(np.append(code, 0))
