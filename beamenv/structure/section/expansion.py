"""What heat does to a section that is free to warp: how it strains and warps, and the stresses that then balance in it.

A field of temperature T strains a point by α T were it alone. With displacements w, the same at every section, and beam strains e
the energy is ½ ∫ (B w + S Z e − α T)ᵀ Q (B w + S Z e − α T) dA. It is least where

    ∫ Bᵀ Q (B w + S Z e) dA = ∫ Bᵀ Q α T dA,        ∫ (S Z)ᵀ Q (B w + S Z e) dA = ∫ (S Z)ᵀ Q α T dA,

the equations of Saint-Venant's solutions with other loads: no part of the section is held, and no resultant is left. What is left
are stresses σ* = Q (B w + S Z e − α T) that do no work on warping that is the same all along. They do on warping that changes, and
their second moments stiffen the twist as those of tension do. Any further strain s of the section stores ½ sᵀ E s beside that work.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed
from beamenv.structure.section.central_solution import Factorised, equilibrium, mean_motion, without
from beamenv.structure.section.element_sums import distinct_elements
from beamenv.structure.section.elements import RIGID, layers, strain_of_tables, turn_of_strains
from beamenv.structure.section.integrals import integrals
from beamenv.structure.section.mesh import Mesh
from beamenv.structure.section.ply_parts import thermal_stress
from beamenv.structure.walls.laminate import Laminate, Ply

Array = NDArray[np.float64]

HEATS = 2
"""1 K everywhere, and 1 K per m along y."""

WARPING = slice(RIGID, RIGID + HEATS)
"""Where shapes are the warping of heat: that, among strains of a section."""

BY_HEAT = np.array([0, 2])
"""Of 1, x and y, those that the temperature follows."""


@dataclass(frozen=True, slots=True, eq=False)
class Expansion(Sealed):
    """What each of ``HEATS`` does to V sections."""

    strain: Array
    """(V, 6, HEATS): beam strains where nothing is held."""
    onward: Array
    """(V, AMPLITUDES, HEATS): work of the balanced stresses, per metre, on the shapes' amplitudes that change by 1 a metre."""
    moments: Array
    """∫σ_zz (1, x, y, x², xy, y²) dA of them (V, 6, HEATS); the first three are zero."""
    warping: Array
    """w (V, K, size, HEATS), of each element's nodes."""

    @classmethod
    def joined(cls, parts: Sequence[Expansion], order: NDArray[np.intp]) -> Expansion:
        """Those of several groups of sections, in an order."""
        return cls(*(np.concatenate([getattr(part, each.name) for part in parts])[order] for each in fields(cls)))

    def turned(self, turn: Array) -> Expansion:
        """The same of shapes mixed by ``turn`` (AMPLITUDES, AMPLITUDES)."""
        return Expansion(self.strain, turn.T @ self.onward, self.moments, self.warping)


@dataclass(frozen=True, slots=True, eq=False)
class ThermalSums:
    """Of the stresses Q α T over each of V·K elements of ``size`` displacements."""

    warping: Array
    """∫ Bᵀ Q α T (V, K, size, HEATS)."""
    derivative: Array
    """∫ Sᵀ Q α T (V, K, size, HEATS)."""
    beam: Array
    """∫ (S Z)ᵀ Q α T (V, K, 6, HEATS)."""
    moments: Array
    """∫ (Q α)_zz T (1, x, y, x², xy, y²) (V, K, 6, HEATS)."""

    @classmethod
    def of(cls, mesh: Mesh, laminates: Sequence[Laminate], which: NDArray[np.intp], pretwist: float) -> ThermalSums:
        """As ``element_sums`` has them: element k of section v has the wall ``laminates[which[v, k]]``."""
        first, of_elements = distinct_elements(mesh, which)
        rows: list[Array] | None = None
        for number, laminate in enumerate(laminates):
            members = np.flatnonzero(which.ravel()[first] == number)
            for low, high, ply in layers(laminate):
                parts = _of_layer(mesh, first[members], low, high, ply, pretwist)
                rows = rows or [np.zeros((len(first), *part.shape[1:])) for part in parts]
                for total, part in zip(rows, parts, strict=True):
                    total[members] += part
        assert rows is not None
        return cls(*(total[of_elements].reshape(*which.shape, *total.shape[1:]) for total in rows))


def _of_layer(mesh: Mesh, elements: NDArray[np.intp], low: float, high: float, ply: Ply, pretwist: float) -> tuple[Array, ...]:
    held, rule = thermal_stress(ply)
    sums, count = integrals(mesh, elements, low, high, rule), len(elements)
    turned = turn_of_strains(mesh.tangents.reshape(-1, 2)[elements])
    stress = turned.swapaxes(-1, -2) @ held
    B, S, Z = strain_of_tables(pretwist)
    on_tables = sums.with_beam.reshape(count, len(B), 3, -1)[:, :, BY_HEAT]
    on_values, on_beam = sums.value_with_beam[..., 0][:, BY_HEAT], sums.of_beam.reshape(count, 3, 3)[:, BY_HEAT]
    warping = np.einsum("ethi,tkc,ek->eich", on_tables, B, stress, optimize=True)
    derivative = np.einsum("ehi,kc,ek->eich", on_values, S, stress, optimize=True)
    beam = np.einsum("eht,tkc,ek->ech", on_beam, Z, stress, optimize=True)
    moments = stress[:, 5, None, None] * sums.moments_of_beam[..., 0][:, BY_HEAT].swapaxes(-1, -2)
    flat = (count, -1, HEATS)
    return warping.reshape(flat), derivative.reshape(flat), beam, moments


def expansion_of(system: Factorised, heat: ThermalSums, shapes: Array, pretwist: float) -> Expansion:
    """That of V sections with shapes (V, K, size, AMPLITUDES)."""
    sums = system.sums
    warping, strain = system.solve(heat.warping, heat.beam.sum(axis=1))
    mean = mean_motion(sums, warping)
    here = sums.gather(without(sums, warping, mean))
    strain = strain + equilibrium(pretwist).T @ mean
    onward = sums.cross.swapaxes(-1, -2) @ here + sums.derivative_strain @ strain[:, None] - heat.derivative
    size = sums.size
    by_warping, by_strain = sums.moments[..., :size], sums.moments[..., 2 * size :]
    moments = (by_warping @ here + by_strain @ strain[:, None] - heat.moments).sum(axis=1)
    return Expansion(strain, (shapes.swapaxes(-1, -2) @ onward).sum(axis=1), moments, here)
