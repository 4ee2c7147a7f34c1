"""The sections of a blade along its span: solid sections at few sizes and with every combination of inlays, and between them."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed, sealed_property
from beamenv.structure.planform import Planform
from beamenv.structure.section.section import Section, mesh_of
from beamenv.structure.section.solid_sections import SolidSections
from beamenv.structure.walls.inlay import Inlay, Strip
from beamenv.structure.walls.laminate import Laminate, Layup

Array = NDArray[np.float64]

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
    """C times as many as the planform's pieces have sizes, combination after combination."""

    @classmethod
    def build(
        cls, section: Section, layup: Layup, planform: Planform, inlays: Sequence[Inlay], cuts: Sequence[Strip] = ()
    ) -> SectionsAlong:
        """Those of a blade whose inlays may lie anywhere; how they expand is known where the planform says how hot they are."""
        kinds = _kinds(inlays)
        codes = _combinations(inlays, kinds)
        strips = tuple(sorted({*cuts, *(inlay.strip for inlay in inlays)}, key=lambda each: (each.wall, each.width, each.offset)))
        hosts = section.hosts(layup)
        sheets = tuple(kind.kind for kind in kinds)
        key = (
            section,
            tuple(hosts.items()),
            sheets,
            codes.tobytes(),
            strips,
            tuple((piece.rate, piece.sizes, piece.temperatures) for piece in planform.pieces),
        )
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
        count = sum(len(piece.sizes) for piece in self.planform.pieces)
        if count == 1:
            return values[which]
        by_size = values.reshape(len(self.codes), count, *values.shape[1:])[which]
        return np.einsum("sn,sn...->s...", self._weights(z), by_size)

    def _weights(self, z: Array) -> Array:
        """(S, sizes): of the sections known, for those at stations z (m)."""
        pieces = self.planform.pieces
        if len(pieces) == 1:
            return self._within(0, z)
        ends = np.array([piece.end for piece in pieces[:-1]])
        where, weights = np.searchsorted(ends, z, side="right"), []
        for k in range(len(pieces)):
            own = where == k
            part = np.zeros((len(z), len(pieces[k].sizes)))
            part[own] = self._within(k, z[own])
            weights.append(part)
        return np.concatenate(weights, axis=1)

    def _within(self, piece: int, z: Array) -> Array:
        """(S, n): of the n sections of a piece, for those of other sizes or temperatures."""
        sizes = self.planform.pieces[piece].nodes
        if len(sizes) == 1:
            return np.ones((len(z), 1))
        scale = self.planform.temperature(z) if self.planform.pieces[piece].by_temperature else self.planform.scale(z)
        if self._smooth[piece]:
            return between(sizes, scale)
        order = np.argsort(sizes)
        return np.stack([np.interp(scale, sizes[order], row[order]) for row in np.eye(len(sizes))], axis=-1)

    @sealed_property
    def _smooth(self) -> tuple[bool, ...]:
        """Whether the polynomial between sizes leaves every section some energy in every strain, piece by piece. That of very thin
        walls under strong pretwist, which warp otherwise at every size, may not; then the mean of two neighbours does.
        """
        found, pieces = [], self.planform.pieces
        energy = self.solid.energy.reshape(len(self.codes), -1, *self.solid.energy.shape[1:])
        size, first = energy.shape[-1], 0
        unit = 1.0 / np.sqrt(np.diagonal(self.solid.energy[0]))
        for piece in pieces:
            sizes, count = piece.nodes, len(piece.sizes)
            halfway = between(sizes, np.linspace(sizes.min(), sizes.max(), 4 * count)) if count > 1 else np.ones((1, 1))
            own = energy[:, first : first + count].reshape(len(self.codes), count, -1)
            every = np.einsum("sn,cne->cse", halfway, own).reshape(-1, size, size) * np.outer(unit, unit)
            found.append(bool(np.linalg.eigvalsh(every).min() > -NOTHING))
            first += count
        return tuple(found)


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
    sizes = np.concatenate([piece.sizes for piece in planform.pieces])
    rates = np.concatenate([np.full(len(piece.sizes), piece.rate) for piece in planform.pieces])
    fitting = np.concatenate([np.full(len(piece.sizes), piece.start < planform.covered) for piece in planform.pieces])
    needed = fitting if fitting.any() else ~fitting
    every = tuple(np.tile(sizes, len(codes)).tolist()), tuple(strips), tuple(np.tile(needed, len(codes)).tolist())
    elements = mesh_of(section, *every)
    hot = [temperature for piece in planform.pieces for temperature in piece.temperatures or (None,) * len(piece.sizes)]
    laminates = dict[Laminate, int]()
    which = np.empty((len(codes), len(sizes), len(elements.edges)), dtype=np.intp)
    under = [(edge.wall, tuple(edge.lies_under(kind) for kind in kinds)) for edge in elements.edges]
    for row, code in enumerate(codes.tolist()):
        for temperature in dict.fromkeys(hot):
            known: dict[tuple[str, tuple[bool, ...]], int] = {}
            for k, (wall, lies) in enumerate(under):
                if (wall, lies) not in known:
                    laminate = hosts[wall]
                    for bit, kind in enumerate(kinds):
                        laminate = kind.let_into(laminate) if code >> bit & 1 and lies[bit] else laminate
                    laminate = laminate if temperature is None else laminate.at(temperature)
                    known[wall, lies] = laminates.setdefault(laminate, len(laminates))
                which[row, [own == temperature for own in hot], k] = known[wall, lies]
    every_one = which.reshape(-1, len(elements.edges))
    heated = planform.temperatures is not None
    return SolidSections.build(elements, list(laminates), every_one, np.tile(rates, len(codes)), heated)


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
