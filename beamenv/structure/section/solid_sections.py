"""What a beam has to know of its sections, from solid elements: stiffness, warping, inertia, and where stresses act.

A section moves as a rigid whole, r, and warps: u = Z r + Σ shape_j a_j(z). The first six shapes are Saint-Venant's, the others
distort the section in its plane. Far from clamp and patches the amplitudes of the first six follow the stress resultants, and the
beam is as stiff as the (6, 6) matrix says; at the clamp they vanish, which Saint-Venant's solution alone cannot do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed, sealed, sealed_property
from beamenv.structure.section.amplitudes import AMPLITUDES, STRAINS, Meaning, saint_venant_strains
from beamenv.structure.section.central_solution import Factorised, central_solution
from beamenv.structure.section.distortion import distortion_shapes
from beamenv.structure.section.element_sums import ElementSums, element_sums
from beamenv.structure.section.elements import ACROSS, RIGID, Places, places, strain_of_tables, turn_of_strains
from beamenv.structure.section.expansion import WARPING, Expansion, ThermalSums, expansion_of
from beamenv.structure.section.integrals import MONOMIALS
from beamenv.structure.section.mesh import Mesh
from beamenv.structure.stations import gauss_rule
from beamenv.structure.walls.inlay import Strip
from beamenv.structure.walls.laminate import Laminate

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SolidSections(Sealed):
    """V sections of one topology, in their own axes."""

    mesh: Mesh
    shapes: Array
    """(V, K, size, AMPLITUDES): displacements of each element's nodes."""
    pretwist: Array
    """(V,), rad/m."""
    stiffness: Array
    """Saint-Venant's (V, 6, 6): rows Vx, Vy, N, Mx, My, Mz."""
    energy: Array
    """(V, STRAINS, STRAINS): twice the strain energy per metre."""
    inertia: Array
    """∫ρ (1, x, y, x², xy, y²) dA (V, 6)."""
    shape_mass: Array
    """(V, AMPLITUDES, AMPLITUDES), per metre; the shapes' momenta on the whole are zero."""
    stress_moments: Array
    """∫σ_zz (1, x, y, x², xy, y²) dA (V, 6, STRAINS)."""
    saint_venant: Array
    """(V, STRAINS, 6): strains of the section per stress resultant, far from clamp and patches."""
    expansion: Expansion | None = None
    """What heat does; None where it was not asked for."""
    _forces: dict[tuple[Strip, float, float, tuple[float, float, float]], Array] = field(default_factory=dict)

    @classmethod
    def build(
        cls, mesh: Mesh, laminates: Sequence[Laminate], which: NDArray[np.intp], pretwist: float | Array, heated: bool = False
    ) -> SolidSections:
        """Sections whose element k has the wall ``laminates[which[v, k]]``; they twist by ``pretwist`` rad/m, all alike or
        each (V,). Of ``heated`` ones it is known how they expand.
        """
        rates = np.broadcast_to(np.asarray(pretwist, dtype=np.float64), (len(which),))
        parts: list[SolidSections] = []
        places, meant = [], None
        for rate in dict.fromkeys(rates.tolist()):
            rows = np.flatnonzero(rates == rate)
            part, meant = cls._of_rate(mesh.rows(rows), laminates, which[rows], rate, meant, heated)
            parts.append(part)
            places.append(rows)
        if len(parts) == 1:
            return parts[0]
        order = np.argsort(np.concatenate(places))
        by_section = ("shapes", "pretwist", "stiffness", "energy", "inertia", "shape_mass", "stress_moments", "saint_venant")
        whole: dict[str, Any] = {name: np.concatenate([getattr(part, name) for part in parts])[order] for name in by_section}
        grown = [part.expansion for part in parts if part.expansion is not None]
        return cls(mesh=mesh, expansion=Expansion.joined(grown, order) if grown else None, **whole)

    @classmethod
    def _of_rate(
        cls, mesh: Mesh, laminates: Sequence[Laminate], which: NDArray[np.intp], rate: float, meant: Meaning | None, heated: bool
    ) -> tuple[SolidSections, Meaning]:
        """Those of one pretwist, and what amplitudes of 1 mean in all. ``meant`` is that of other sections of the blade."""
        sums = element_sums(mesh, laminates, which, rate)
        system = Factorised.of(sums)
        central = central_solution(system, rate)
        if meant is None:
            meant = Meaning.of(system.first, central, bool(len(mesh.loose_ends)))
        warping, amplitudes = meant.shapes(central)
        shapes = np.concatenate([warping, distortion_shapes(system, meant.loads)], axis=-1)
        here = sums.gather(shapes)
        heat = ThermalSums.of(mesh, laminates, which, rate) if heated else None
        sections = cls(
            mesh=mesh,
            shapes=here,
            pretwist=np.full(len(which), rate),
            stiffness=central.stiffness,
            energy=_energy(sums, here),
            inertia=sums.inertia,
            shape_mass=(here.swapaxes(-1, -2) @ sums.inertial(here)).sum(axis=1),
            stress_moments=_stress_moments(sums, here),
            saint_venant=saint_venant_strains(central, amplitudes, rate),
            expansion=None if heat is None else expansion_of(system, heat, here, rate),
        )
        return sections, meant

    def aligned(self, other: SolidSections) -> SolidSections:
        """The same sections with distortions that mean what equal amplitudes mean in ``other``, whose elements are cut elsewhere.

        A vibration's sign is anybody's choice, and of two with one frequency so is every mixture: here they move the lines that
        both have as nearly alike as may be (Procrustes).
        """
        apart = np.linalg.norm(self.mesh.points[0][:, None] - other.mesh.points[0][None], axis=-1)
        mine, its = np.nonzero(apart < 1e-9 * np.abs(self.mesh.points).max())
        moved, wanted = (
            solid.shapes[0, lines, : 3 * (ACROSS + 1), RIGID:].reshape(-1, AMPLITUDES - RIGID)
            for solid, lines in ((self, mine), (other, its))
        )
        left, _, right = np.linalg.svd(moved.T @ wanted)
        turn, strains = np.eye(AMPLITUDES), np.eye(STRAINS)
        turn[RIGID:, RIGID:] = left @ right
        strains[RIGID : RIGID + AMPLITUDES, RIGID : RIGID + AMPLITUDES] = strains[RIGID + AMPLITUDES :, RIGID + AMPLITUDES :] = turn
        return replace(
            self,
            shapes=self.shapes @ turn,
            energy=strains.T @ self.energy @ strains,
            stress_moments=self.stress_moments @ strains,
            shape_mass=turn.T @ self.shape_mass @ turn,
            expansion=None if self.expansion is None else self.expansion.turned(turn),
            _forces={},
        )

    @property
    def classical_stiffness(self) -> Array:
        """(V, 4, 4) for (w′, θx′, θy′, φ′): no transverse force acts."""
        return np.asarray(np.linalg.inv(np.linalg.inv(self.stiffness)[:, 2:, 2:]))

    @property
    def saint_venant_moments(self) -> Array:
        """``stress_moments`` (V, 6, 6) per beam strain, far from clamp and patches."""
        return np.asarray(self.stress_moments @ self.saint_venant @ self.stiffness)

    @property
    def depths(self) -> Array:
        """(V, 2), m: least and greatest y of the walls' faces."""
        mesh = self.mesh
        half = 0.5 * mesh.thickness[:, None]
        ends = [(mesh.points, mesh.directions), (mesh.last_points, mesh.last_directions)]
        faces = [(P + side * half * d)[..., 1] for P, d in ends for side in (1.0, -1.0)]
        return np.stack([np.min(faces, axis=(0, 2)), np.max(faces, axis=(0, 2))], axis=-1)

    @property
    def tension_centre(self) -> Array:
        """(V, 2), m: where an axial force bends the section in neither direction."""
        compliance = np.linalg.inv(self.stiffness)[:, 2:5, 2:5]
        force = np.linalg.solve(compliance, np.array([1.0, 0.0, 0.0])[:, None])[..., 0]
        return np.stack([-force[:, 2], force[:, 1]], axis=-1) / force[:, :1]

    @property
    def shear_centre(self) -> Array:
        """(V, 2), m: where a transverse force twists the section in no direction, bending moments held at zero."""
        compliance = np.linalg.inv(self.stiffness)
        twist = compliance[:, 5, 5]
        return np.stack([-compliance[:, 5, 1], compliance[:, 5, 0]], axis=-1) / twist[:, None]

    def face_points(self) -> Array:
        """(V, F, 2), m: where strains are watched, on lines between elements: the outer face, the inner one too of walls that have
        loose ends or stand on others, and the loose ends.
        """
        mesh = self.mesh
        points = []
        for elements, last, side in faces_of(self.mesh):
            P, d = (mesh.last_points, mesh.last_directions) if last else (mesh.points, mesh.directions)
            points.append(P[:, elements] + side * 0.5 * mesh.thickness[elements, None] * d[:, elements])
        return np.concatenate(points, axis=1)

    @sealed_property
    def face_strain(self) -> Array:
        """Spanwise strain (V, F, STRAINS) there, per strain of the section."""
        sections, count = self.mesh.points.shape[:2]
        found = []
        for elements, last, side in faces_of(self.mesh):
            strain = np.empty((sections, len(elements), self._strains))
            for thickness in np.unique(self.mesh.thickness[elements]):
                own = np.flatnonzero(self.mesh.thickness[elements] == thickness)
                members = (np.arange(sections)[:, None] * count + elements[own]).ravel()
                along, depth, one = np.array([1.0 if last else -1.0]), np.array([side * 0.5 * thickness]), np.ones(1)
                at = places(self.mesh, members, along, depth, one, one)
                strain[:, own] = self._strain(at, members)[..., 0, 5, :].reshape(sections, len(own), -1)
            found.append(strain)
        return np.concatenate(found, axis=1)

    def layer_force(self, strip: Strip, low: float, high: float, stress: tuple[float, float, float]) -> Array:
        """Work (V, STRAINS) per strain of the section and per metre, of stresses (ss, zz, sz), Pa, in a layer from ``low`` to
        ``high`` (m from the mid-line) of a strip of a wall. Worked out once.
        """
        key = strip, low, high, stress
        if key not in self._forces:
            self._forces[key] = sealed(self._layer_force(strip, low, high, np.array(stress)))
        return self._forces[key]

    def _layer_force(self, strip: Strip, low: float, high: float, stress: Array) -> Array:
        under = [strip in edge.strips for edge in self.mesh.edges]
        members = np.flatnonzero(np.tile(under, len(self.shapes)))
        along, weight_along = gauss_rule(self.mesh.order + 1)
        depth, weight = gauss_rule(2)
        half = 0.5 * (high - low)
        here = places(self.mesh, members, along, low + half * (1.0 + depth), weight_along, half * weight)
        turned = turn_of_strains(self.mesh.tangents.reshape(-1, 2)[members]).swapaxes(-1, -2)[..., [0, 5, 3]] @ stress
        strain = self._strain(here, members)
        work = np.einsum("eqkn,eq,ek->en", strain, here.weight, turned, optimize=True)
        return np.asarray(work.reshape(len(self.shapes), -1, self._strains).sum(axis=1))

    @property
    def _strains(self) -> int:
        """STRAINS, or fewer where other shapes are looked at."""
        return RIGID + 2 * self.shapes.shape[-1]

    @sealed_property
    def face_strain_by_heat(self) -> Array:
        """(V, F, HEATS): spanwise strain there by the warping that heat brings about, beside that of the beam strains."""
        return np.array(self._as_heated.face_strain[..., WARPING])

    def layer_work_by_heat(self, strip: Strip, low: float, high: float, stress: tuple[float, float, float]) -> Array:
        """(V, HEATS): as ``layer_force``, of the free strains and the warping of heat."""
        assert self.expansion is not None
        moved = self._as_heated._layer_force(strip, low, high, np.array(stress))
        return moved[:, WARPING] + (moved[:, None, :RIGID] @ self.expansion.strain)[:, 0]

    @sealed_property
    def _as_heated(self) -> SolidSections:
        """With the warping of heat as shapes."""
        assert self.expansion is not None
        return replace(self, shapes=self.expansion.warping, expansion=None, _forces={})

    def _strain(self, here: Places, members: NDArray[np.intp]) -> Array:
        """(E, Q, 6, STRAINS) at points of some elements, by their flat indices, of the shapes."""
        shapes = self.shapes.reshape(-1, *self.shapes.shape[2:])[members]
        e, q, nodes = here.value.shape
        tables = here.tables()
        rates = self.pretwist[members // len(self.mesh.edges)]
        if np.any(rates != rates[0]):
            return self._strain_by_rate(here, members, rates)
        B, S, Z = strain_of_tables(float(rates[0]))
        moved = shapes.reshape(e, nodes, 3, -1)
        of_shapes = tables[..., : 4 * nodes].reshape(e, q * 4, nodes) @ moved.reshape(e, nodes, -1)
        fields = of_shapes.reshape(e, q, 4, 3, -1)
        strained = np.einsum("eqtcj,tkc->eqkj", fields, B, optimize=True)
        onward = np.einsum("eqcj,kc->eqkj", fields[:, :, 3], S)
        beam = np.einsum("eqt,tkc->eqkc", tables[..., 4 * nodes :], Z)
        return np.concatenate([beam, strained, onward], axis=-1)

    def _strain_by_rate(self, here: Places, members: NDArray[np.intp], rates: Array) -> Array:
        strain = np.empty((*here.x.shape, 6, self._strains))
        for rate in np.unique(rates):
            own = rates == rate
            parts = {each.name: getattr(here, each.name)[own] for each in fields(here)}
            strain[own] = self._strain(replace(here, **parts), members[own])
        return strain


def faces_of(mesh: Mesh) -> list[tuple[NDArray[np.intp], bool, float]]:
    """Where strains are watched: elements, whether at their last line or their first, and on which side, 1 or −1."""
    outer = np.arange(len(mesh.edges))
    loose, both = mesh.loose_ends, mesh.open_elements
    found = [(outer, False, 1.0), (both, False, -1.0), (loose, True, 1.0), (loose, True, -1.0)]
    return [(elements, last, side) for elements, last, side in found if len(elements)]


def _energy(sums: ElementSums, shapes: Array) -> Array:
    """(V, STRAINS, STRAINS)."""
    sections, nothing = len(shapes), np.zeros_like
    beam = np.broadcast_to(np.eye(RIGID, STRAINS), (sections, RIGID, STRAINS))
    padding = np.zeros((*shapes.shape[:3], RIGID))
    warping = np.concatenate([padding, shapes, nothing(shapes)], axis=-1)
    onward = np.concatenate([padding, nothing(shapes), shapes], axis=-1)
    return sums.energy(warping, onward, beam)


def _stress_moments(sums: ElementSums, shapes: Array) -> Array:
    """(V, 6, STRAINS)."""
    size = sums.size
    warp, onward, beam = (sums.moments[..., part] for part in (slice(size), slice(size, 2 * size), slice(2 * size, None)))
    return np.asarray(np.concatenate([beam, warp @ shapes, onward @ shapes], axis=-1).sum(axis=1)).reshape(-1, MONOMIALS, STRAINS)
