"""Integrals over the solid elements of V sections that differ in size or in what their walls are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.section.elements import (
    ACROSS,
    RIGID,
    layers,
    lobatto_nodes,
    rigid_motion,
    stiffness_in_section,
    strain_of_tables,
)
from beamenv.structure.section.integrals import MONOMIALS, integrals
from beamenv.structure.section.lines import Lines
from beamenv.structure.section.mesh import Mesh
from beamenv.structure.section.ply_parts import PlyPart, parts_of
from beamenv.structure.walls.laminate import Laminate

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class ElementSums:
    """Sums over the points of each of V·K elements of ``size`` displacements: energies, mass, moments of the spanwise stress."""

    warping: Array
    """∫ Bᵀ Q B (V, K, size, size)."""
    cross: Array
    """∫ Bᵀ Q S (V, K, size, size)."""
    derivative: Array
    """∫ Sᵀ Q S (V, K, size, size)."""
    beam_strain: Array
    """∫ Bᵀ Q S Z (V, K, size, 6)."""
    derivative_strain: Array
    """∫ Sᵀ Q S Z (V, K, size, 6)."""
    beam: Array
    """∫ (S Z)ᵀ Q S Z (V, K, 6, 6)."""
    moments: Array
    """∫ σ_zz (1, x, y, x², xy, y²) dA (V, K, 6, 2 size + 6), per warping, per its derivative and per beam strain."""
    mass: Array
    """∫ ρ (shape × shape) dA (V, K, nodes, nodes), kg/m."""
    inertia: Array
    """∫ ρ (1, x, y, x², xy, y²) dA (V, 6)."""
    middles: Array
    """(V, lines, 2), m: where lines cross the mid-line, joints aside."""
    reaches: Array
    """(V, lines, 2), m: from there to the outer face along the line."""
    lines: Lines
    thickness: float
    """m, of the thinnest wall."""

    @property
    def first(self) -> ElementSums:
        """That of the first section alone."""
        arrays = {each.name: getattr(self, each.name)[:1] for each in fields(self) if each.name not in ("lines", "thickness")}
        return replace(self, **arrays)

    @property
    def size(self) -> int:
        """Displacements of an element."""
        return self.warping.shape[-1]

    @property
    def rigid(self) -> Array:
        """(V, lines, 12, 6): rigid motion of all lines."""
        motion = np.zeros((*self.middles.shape[:2], ACROSS + 1, 3, RIGID))
        motion[:, :, 0] = rigid_motion(self.middles[..., 0], self.middles[..., 1])
        motion[:, :, 1, :, 3:] = rigid_motion(self.reaches[..., 0], self.reaches[..., 1])[..., 3:]
        return motion.reshape(*self.middles.shape[:2], -1, RIGID)

    @property
    def rigid_lines(self) -> Array:
        """(V, 12 L, 6): rigid motion of the lines that the equations are of."""
        return self.rigid[:, self.lines.solved].reshape(len(self.middles), -1, RIGID)

    @property
    def nodes(self) -> Array:
        """(V, lines, 4, 2), m: Lobatto's nodes on the lines."""
        return np.asarray(self.middles[:, :, None] + lobatto_nodes(ACROSS)[:, None] * self.reaches[:, :, None])

    def gather(self, lines: Array) -> Array:
        """(V, K, size, c): displacements of each element from those of the lines (V, lines, 12, c)."""
        return self.lines.gather(lines)

    def energy(self, warping: Array, derivative: Array, strain: Array) -> Array:
        """∫ εᵀ Q ε (V, c, c) of c states: warping and its derivative (V, K, size, c), beam strain (V, 6, c)."""
        strain = strain[:, None]
        transposed = (warping.swapaxes(-1, -2), derivative.swapaxes(-1, -2), strain.swapaxes(-1, -2))
        stress = (
            self.warping @ warping + self.cross @ derivative + self.beam_strain @ strain,
            self.cross.swapaxes(-1, -2) @ warping + self.derivative @ derivative + self.derivative_strain @ strain,
            self.beam_strain.swapaxes(-1, -2) @ warping + self.derivative_strain.swapaxes(-1, -2) @ derivative + self.beam @ strain,
        )
        energies = [left @ right for left, right in zip(transposed, stress, strict=True)]
        return np.asarray((energies[0] + energies[1] + energies[2]).sum(axis=1))

    def inertial(self, warping: Array) -> Array:
        """M times displacements of elements (V, K, size, c)."""
        nodes = self.mass.shape[-1]
        shape = warping.shape
        return (self.mass @ warping.reshape(*shape[:2], nodes, -1)).reshape(shape)


def element_sums(mesh: Mesh, laminates: Sequence[Laminate], which: NDArray[np.intp], pretwist: float) -> ElementSums:
    """Those of V sections: the mesh's S sizes are V of them, and element k of section v has the wall ``laminates[which[v, k]]``."""
    sections, count = which.shape
    nodes = (mesh.order + 1) * (ACROSS + 1)
    first, of_elements = distinct_elements(mesh, which)
    totals = _Totals.zeros(len(first), nodes)
    for number, laminate in enumerate(laminates):
        members = np.flatnonzero(which.ravel()[first] == number)
        for low, high, ply in layers(laminate):
            layer = _Layer(members, first[members], low, high)
            for part in parts_of(ply):
                totals.add(mesh, layer, part, pretwist)
    shaped = {name: values[of_elements].reshape(sections, count, *values.shape[1:]) for name, values in vars(totals).items()}
    inertia = shaped.pop("inertia").sum(axis=1)
    middles, reaches = lines_across(mesh)
    thinnest = float(mesh.thickness.min())
    return ElementSums(**shaped, inertia=inertia, middles=middles, reaches=reaches, lines=Lines.of(mesh), thickness=thinnest)


@dataclass(frozen=True, slots=True, eq=False)
class _Layer:
    """A layer of one ply and the elements that have it, by their places among the distinct ones and in the mesh."""

    members: NDArray[np.intp]
    in_mesh: NDArray[np.intp]
    low: float
    high: float


def distinct_elements(mesh: Mesh, which: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Elements (flat indices into the mesh) of which no two are alike, and (V·K,) which of them each element is."""
    _, size = np.unique(mesh.points.reshape(len(which), -1), axis=0, return_inverse=True)
    place = np.arange(which.shape[1])
    key = (size.reshape(-1, 1) * which.shape[1] + place) * (which.max() + 1) + which
    _, first, of_elements = np.unique(key.ravel(), return_index=True, return_inverse=True)
    return first, of_elements


@dataclass(frozen=True, eq=False)
class _Totals:
    """The fields of ``ElementSums`` while layer after layer is added, (E, …)."""

    warping: Array
    cross: Array
    derivative: Array
    beam_strain: Array
    derivative_strain: Array
    beam: Array
    moments: Array
    mass: Array
    inertia: Array

    @classmethod
    def zeros(cls, elements: int, nodes: int) -> _Totals:
        size = 3 * nodes
        square, strain = (elements, size, size), (elements, size, RIGID)
        moments = (elements, MONOMIALS, 2 * size + RIGID)
        shapes = square, square, square, strain, strain, (elements, RIGID, RIGID), moments, (elements, nodes, nodes)
        return cls(*(np.zeros(shape) for shape in (*shapes, (elements, MONOMIALS))))

    def add(self, mesh: Mesh, layer: _Layer, part: PlyPart, pretwist: float) -> None:
        """∫ table × table over the layer, contracted with what a pair of tables means in energy."""
        sums = integrals(mesh, layer.in_mesh, layer.low, layer.high, part.rule)
        if part.density:
            self.mass[layer.members] += part.density * sums.value
            self.inertia[layer.members] += part.density * sums.area
        if part.stiffness is None:
            return
        stiffness = stiffness_in_section(part.stiffness, mesh.tangents.reshape(-1, 2)[layer.in_mesh])
        B, S, Z = strain_of_tables(pretwist)
        stressed_B, stressed_S, stressed_Z = (_stressed(stiffness, rows) for rows in (B, S[None], Z))
        at, count = layer.members, len(layer.in_mesh)
        self.warping[at] += _summed(_meaning(B, stressed_B), sums.square)
        self.cross[at] += _summed(_meaning(B, stressed_S), sums.values)
        self.derivative[at] += _summed(_meaning(S[None], stressed_S), sums.value[:, None])
        self.beam_strain[at] += _summed(_meaning(B, stressed_Z), sums.with_beam)
        self.derivative_strain[at] += _summed(_meaning(S[None], stressed_Z), sums.value_with_beam)
        self.beam[at] += _summed(_meaning(Z, stressed_Z), sums.of_beam)
        parts = ((stressed_B, sums.moments), (stressed_S, sums.moments_of_value), (stressed_Z, sums.moments_of_beam))
        spanwise = [_summed(stressed[:, :, None, 5], moments).reshape(count, MONOMIALS, -1) for stressed, moments in parts]
        self.moments[at] += np.concatenate(spanwise, axis=-1)


def _stressed(stiffness: Array, rows: Array) -> Array:
    """(E, T, 6, c): stresses of strains (T, 6, c)."""
    return np.asarray(stiffness[:, None] @ rows)


def _meaning(left: Array, stressed: Array) -> Array:
    """(E, T·U, c, d): energy of a pair of tables, from strains (T, 6, c) and stresses (E, U, 6, d)."""
    energy = left.swapaxes(-1, -2)[None, :, None] @ stressed[:, None]
    return energy.reshape(len(stressed), -1, *energy.shape[-2:])


def _summed(meaning: Array, integrals: Array) -> Array:
    """Σ over T pairs of tables: (E, T, c, d) and (E, T, i, j) to (E, ic, jd)."""
    count, pairs, c, d = meaning.shape
    i, j = integrals.shape[2:]
    product = integrals.reshape(count, pairs, -1).swapaxes(-1, -2) @ meaning.reshape(count, pairs, -1)
    return product.reshape(count, i, j, c, d).transpose(0, 1, 3, 2, 4).reshape(count, i * c, j * d)


def lines_across(mesh: Mesh) -> tuple[Array, Array]:
    """(S, lines, 2) each, m: where all lines, joints aside, cross the mid-line, and from there to the outer face."""
    half = 0.5 * mesh.thickness[:, None]
    first, last = mesh.points, mesh.last_points
    reach, last_reach = half * mesh.directions, half * mesh.last_directions
    share = 0.5 * (1.0 + lobatto_nodes(mesh.order)[1:-1])[:, None]
    free = mesh.lines < mesh.count

    def across(start: Array, end: Array) -> Array:
        between = np.empty((len(start), mesh.count, 2))
        for at, values in ((1, end), (0, start)):
            between[:, mesh.lines[free[:, at], at]] = values[:, free[:, at]]
        inner = (1.0 - share) * start[:, :, None] + share * end[:, :, None]
        return np.concatenate([between, inner.reshape(len(start), -1, 2)], axis=1)

    return across(first, last), across(reach, last_reach)
