"""Saint-Venant's solutions of a section, by solid elements: what its stiffness (6, 6) is, and how it warps.

A uniform pretwisted beam under end loads has stress resultants θ = (Vx, Vy, N, Mx, My, Mz) that obey θ′ = Tθ, and displacements
u = Z r + W θ: a rigid motion r of the section and warping in proportion to θ. With strains ε = B W θ + S W T θ + S Z Ψ θ, virtual
work of any warping and of any beam strain gives

    ∫ Bᵀ Q ε dA = (∫ Sᵀ Q ε dA) T,        ∫ (S Z)ᵀ Q ε dA = 1

(Giavotto et al., Computers & Structures 16, 1983; here in axes that turn with the pretwist). The terms with T follow by iteration,
exactly after two passes without pretwist. The section's stiffness is the inverse of the compliance ∫ εᵀ Q ε dA.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.structure.section.element_sums import ElementSums
from beamenv.structure.section.elements import RIGID
from beamenv.structure.section.equations import Factors, assembled, diagonal_of
from beamenv.structure.section.lines import PER_LINE

Array = NDArray[np.float64]

PASSES = 10
"""Most iterations for the pretwist's terms before they are extrapolated; on a blade each is some 50 times smaller than the last,
while in thin, wide, strongly pretwisted walls they may grow."""

CYCLES = 30
"""Most extrapolations; two turns a blade take more than eight."""

CONVERGED = 1e-6

UNSETTLED = 1e-3
"""Largest change of the beam strain in the last pass, relative to the largest, of a solution that is taken at all."""

CORRECTIONS = 4
"""Most of a solution; of a blade's sections one is made, of 10⁻¹⁰ of the solution."""

EXACT = 1e-8
"""Part of a solution that is not worth another correction."""

DOUBT = 1e-3
"""Largest part of a solution that its last correction may be: displacements are so uncertain then, stiffnesses by its square."""


def equilibrium(pretwist: float) -> Array:
    """T (6, 6): θ′ = T θ in axes that turn by ``pretwist`` rad/m."""
    around = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    whole = np.zeros((RIGID, RIGID))
    whole[:3, :3] = whole[3:, 3:] = -pretwist * around
    whole[3:, :3] = -around
    return whole


@dataclass(frozen=True, slots=True, eq=False)
class Factorised:
    """The equations of V sections for warping and beam strain, ready to be solved; the inside of elements is eliminated, but for
    those that joints lie on.
    """

    sums: ElementSums
    inner: Array
    """(V, K, i, i): inverse of the inside of each element; zero where that stays."""
    coupling: Array
    """(V, K, i, b + 6): between the inside, and the two ends of the element and the beam strain."""
    factors: tuple[Factors, ...]
    scale: Array
    """(V, 12 L + 6): units of displacements on lines and of beam strain, in which every equation has 1 on its diagonal."""
    held: Array
    """(V, 12 L, 6): averages of the lines' rigid motion, in their units, of which the squares are added to the energy."""

    @classmethod
    def of(cls, sums: ElementSums) -> Factorised:
        """With whatever rigid motion leaves no energy held at zero on average; ``ValueError`` where walls are too thin for that."""
        size = sums.size
        ends, inside = _ends(size), slice(PER_LINE, size - PER_LINE)
        stiffness = sums.warping
        full = np.concatenate([stiffness, sums.beam_strain], axis=-1)
        inner = _inverse(sums, stiffness[..., inside, inside])
        inner[:, sums.lines.hosts] = 0.0
        columns = np.concatenate([ends, size + np.arange(RIGID)])
        coupling = full[..., inside, :][..., columns]
        bordered = np.zeros((*stiffness.shape[:2], len(columns), len(columns)))
        bordered[..., : len(ends), :] = full[..., ends, :][..., columns]
        bordered[..., len(ends) :, : len(ends)] = sums.beam_strain[..., ends, :].swapaxes(-1, -2)
        bordered[..., len(ends) :, len(ends) :] = sums.beam
        bordered -= coupling.swapaxes(-1, -2) @ inner @ coupling
        systems = [assembled(sums, v, each) for v, each in enumerate(bordered)]
        scale = np.stack([_unit(sums, diagonal_of(system)) for system in systems])
        held = sums.rigid_lines * scale[:, :-RIGID, None]
        held /= np.linalg.norm(held, axis=1, keepdims=True)
        factors = tuple(Factors.of(*each) for each in zip(systems, scale, held, strict=True))
        return cls(sums, inner, coupling, factors, scale, held)

    @property
    def first(self) -> Factorised:
        """That of the first section alone."""
        return Factorised(self.sums.first, self.inner[:1], self.coupling[:1], self.factors[:1], self.scale[:1], self.held[:1])

    def solve(self, loads: Array, resultants: Array) -> tuple[Array, Array]:
        """Warping (V, lines, 12, c) and beam strain (V, 6, c) under nodal loads of the elements (V, K, size, c), not yet added up
        where they meet, and resultants (V, 6, c); ``ValueError`` where walls are so thin that too few digits are left.

        What a solution leaves over is solved for in its turn, which tells by how much it was wrong.
        """
        sums = self.sums
        warping, strain = self._solve(loads, resultants, np.zeros((len(loads), RIGID, loads.shape[-1])))
        for _ in range(CORRECTIONS):
            here, whole, solved = sums.gather(warping), strain[:, None], self._in_units(warping, strain)
            left = loads - sums.warping @ here - sums.beam_strain @ whole
            missing = resultants - (sums.beam_strain.swapaxes(-1, -2) @ here + sums.beam @ whole).sum(axis=1)
            correction, more = self._solve(left, missing, self.held.swapaxes(-1, -2) @ solved[:, :-RIGID])
            wrong, size = (np.linalg.norm(each, axis=1) for each in (self._in_units(correction, more), solved))
            warping, strain = warping + correction, strain + more
            if np.all(wrong <= EXACT * size):
                break
        if not np.all(wrong <= DOUBT * size):
            raise _too_thin(sums)
        return warping, strain

    def _in_units(self, warping: Array, strain: Array) -> Array:
        """(V, 12 L + 6, c): displacements of the lines solved for and beam strain."""
        lines = warping[:, self.sums.lines.solved].reshape(len(warping), -1, warping.shape[-1])
        return np.asarray(np.concatenate([lines, strain], axis=1) / self.scale[..., None])

    def _solve(self, loads: Array, resultants: Array, rigid: Array) -> tuple[Array, Array]:
        """Once, and with the rigid motion (V, 6, c) taken back by which a first solution was held."""
        size, lines = self.sums.size, self.sums.lines
        inside = slice(PER_LINE, size - PER_LINE)
        freed = self.inner @ loads[..., inside, :]
        passed = self.coupling.swapaxes(-1, -2) @ freed
        on_ends = loads[..., _ends(size), :] - passed[..., : 2 * PER_LINE, :]
        strain_loads = resultants - passed[..., 2 * PER_LINE :, :].sum(axis=1)
        on_lines = _on_lines(self.sums, on_ends, loads[:, lines.hosts, inside])
        count, columns = on_lines.shape[1], loads.shape[-1]
        right = self.scale[..., None] * np.concatenate([on_lines, strain_loads], axis=1)
        right[:, :count] -= self.held @ rigid
        scaled = np.stack([factor.solve(each) for factor, each in zip(self.factors, right, strict=True)])
        solved = self.scale[..., None] * scaled
        strain = solved[:, count:]
        found = np.zeros((len(loads), lines.free, PER_LINE, columns))
        found[:, lines.solved] = solved[:, :count].reshape(len(loads), -1, PER_LINE, columns)
        around = lines.gather(found)[..., _ends(size), :]
        known = np.concatenate([around, np.broadcast_to(strain[:, None], (*around.shape[:2], RIGID, columns))], axis=2)
        within = freed - self.inner @ (self.coupling @ known)
        rest = np.delete(np.arange(within.shape[1]), lines.hosts)
        own = lines.of_elements[rest, 1:-1]
        found[:, own] = within[:, rest].reshape(len(loads), *own.shape, PER_LINE, columns)
        return found, strain


def _ends(size: int) -> NDArray[np.intp]:
    return np.concatenate([np.arange(PER_LINE), np.arange(size - PER_LINE, size)])


def _too_thin(sums: ElementSums) -> ValueError:
    if not np.isfinite(sums.warping).all():
        return ValueError("section cannot be computed: its numbers are not finite.")
    allowed = "large enough beside the section, and plies near enough to one another in stiffness, to leave digits to compute with"
    return Refused("thickness", sums.thickness, allowed)


def _unit(sums: ElementSums, diagonal: Array) -> Array:
    """(…, n): 1/√ of diagonals (…, n)."""
    if not np.all(diagonal > 0.0):
        raise _too_thin(sums)
    return np.asarray(1.0 / np.sqrt(diagonal))


def _inverse(sums: ElementSums, stiffness: Array) -> Array:
    """Of symmetric matrices (…, n, n) whose rows differ in scale."""
    unit = _unit(sums, np.diagonal(stiffness, axis1=-2, axis2=-1))
    return np.asarray(unit[..., None] * np.linalg.inv(unit[..., None] * stiffness * unit[..., None, :]) * unit[..., None, :])


def _on_lines(sums: ElementSums, on_ends: Array, inside: Array) -> Array:
    """(V, 12 L, c): loads on the lines solved for, of those on ends of elements (V, K, 24, c) and inside hosts (V, H, i, c)."""
    lines, (sections, _, _, columns) = sums.lines, on_ends.shape
    count, places = len(lines.solved), lines.places
    total = np.zeros((sections, count + len(lines.faces), PER_LINE, columns))
    for at, part in ((0, slice(0, PER_LINE)), (-1, slice(PER_LINE, None))):
        total[:, places[lines.of_elements[:, at]]] += on_ends[:, :, part]
    if not len(lines.faces):
        return total.reshape(sections, -1, columns)
    own = places[lines.of_elements[lines.hosts, 1:-1]]
    total[:, own] += inside.reshape(sections, *own.shape, PER_LINE, columns)
    flat = total.reshape(sections, -1, columns)
    return np.asarray(flat[:, : count * PER_LINE] + lines.follow.T @ flat[:, count * PER_LINE :])


@dataclass(frozen=True, slots=True, eq=False)
class CentralSolution:
    """Warping and stiffness of V sections."""

    warping: Array
    """W (V, lines, 12, 6): displacements on the lines across the wall, per stress resultant, that move no mass on the whole."""
    strain: Array
    """Ψ (V, 6, 6): beam strain per stress resultant, of the mean motion of the section's mass."""
    stiffness: Array
    """(V, 6, 6) for (γx, γy, w′, θx′, θy′, φ′): rows Vx, Vy, N, Mx, My, Mz."""


def central_solution(system: Factorised, pretwist: float) -> CentralSolution:
    """Saint-Venant's six solutions; ``ValueError`` where the walls are too thin for the digits there are, or for the pretwist."""
    sums = system.sums
    sections = len(sums.warping)
    T, one = equilibrium(pretwist), np.broadcast_to(np.eye(RIGID), (sections, RIGID, RIGID))
    warping = np.zeros((sections, sums.lines.free, PER_LINE, RIGID))
    strain = np.zeros((sections, RIGID, RIGID))
    for _ in range(CYCLES):
        passes = [(warping, strain)]
        for _ in range(PASSES):
            here = sums.gather(warping)
            onward = here @ T
            stress = sums.cross.swapaxes(-1, -2) @ here + sums.derivative @ onward + sums.derivative_strain @ strain[:, None]
            loads = stress @ T - sums.cross @ onward
            resultants = one - (sums.derivative_strain.swapaxes(-1, -2) @ onward).sum(axis=1)
            before, (warping, strain) = strain, system.solve(loads, resultants)
            passes.append((warping, strain))
            change = np.abs(strain - before).max() / np.abs(strain).max()
            if converged := bool(change <= CONVERGED):
                break
        if converged:
            break
        warping, strain = extrapolated(passes)
    if not change <= UNSETTLED:
        raise Refused("thickness", sums.thickness, f"large enough beside the section for a pretwist of {pretwist:.3g} rad/m")
    here = sums.gather(warping)
    compliance = sums.energy(here, here @ T, strain)
    inverse = np.linalg.inv(compliance)
    mean = mean_motion(sums, warping)
    strain = strain + mean @ T + T.T @ mean
    return CentralSolution(without(sums, warping, mean), strain, 0.5 * (inverse + inverse.swapaxes(-1, -2)))


def extrapolated(passes: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Limit of an iteration that need not converge, from its passes: the mean of them that the next pass changes least.

    Reduced rank extrapolation (Smith, Ford and Sidi, SIAM Review 29, 1987).
    """
    warpings, strains = (np.stack(each) for each in zip(*passes, strict=True))
    changes = np.diff(warpings, axis=0)
    warping, strain = np.empty_like(warpings[0]), np.empty_like(strains[0])
    for v in range(len(warping)):
        change = changes[:, v].reshape(len(changes), -1)
        share, *_ = np.linalg.lstsq((change[1:] - change[0]).T, -change[0], rcond=None)
        weight = np.concatenate([[1.0 - share.sum()], share])
        warping[v], strain[v] = (np.tensordot(weight, each[:-1, v], axes=1) for each in (warpings, strains))
    return warping, strain


def mean_motion(sums: ElementSums, warping: Array) -> Array:
    """(V, 6, c): the rigid motion whose momentum that of displacements (V, lines, 12, c) is."""
    rigid = sums.gather(sums.rigid).swapaxes(-1, -2)
    momentum = (rigid @ sums.inertial(sums.gather(warping))).sum(axis=1)
    inertia = (rigid @ sums.inertial(sums.gather(sums.rigid))).sum(axis=1)
    return np.asarray(np.linalg.solve(inertia, momentum))


def without(sums: ElementSums, warping: Array, mean: Array) -> Array:
    """Displacements (V, lines, 12, c) less a rigid motion (V, 6, c)."""
    return warping - sums.rigid @ mean[:, None]
