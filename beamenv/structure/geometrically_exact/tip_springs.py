"""Springs between the tip and what does not rotate away from the hub: they hold back displacements, turns, or both.

With k the stiffnesses of displacements and turns along and about the hub's axes the energy is

    ½ Σ kᵢ uᵢ² + tr A (1 − R),        A = ½ tr(K) 1 − K,    K = diag(k₄, k₅, k₆),

at the tip, R being the turn of its section. About one axis alone that is kᵢ (1 − cos ϑ), so that the moment is kᵢ sin ϑ. A spin ϑ
that is added, exp(ϑ̂) R, changes it by ϑ · axial(RA − ARᵀ) + ½ ϑᵀ [tr(RA) 1 − sym(RA)] ϑ.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed
from beamenv.structure.geometrically_exact.kinematics import MOVE, SPIN
from beamenv.structure.geometrically_exact.rotations import rotation
from beamenv.structure.geometrically_exact.tables import increment_rows
from beamenv.structure.span_space import SpanSpace

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class TipSprings(Sealed):
    """On a blade of N coefficients."""

    rows: Array
    """(6, N): displacement and rotation vector at the tip."""
    stiffness: Array
    """(6,): N/m along lag, flap and span, N m/rad about them."""

    @classmethod
    def of(cls, space: SpanSpace, stiffness: tuple[float, ...]) -> TipSprings:
        """At the tip of a blade."""
        rows = increment_rows(space, np.array([space.length]))[0]
        return cls(np.concatenate([rows[MOVE], rows[SPIN]]), np.array(stiffness))

    def force(self, q: Array) -> Array:
        """(N,): the energy's change per displacement and spin, at coefficients q."""
        turned = self._turned(q)
        axial = (turned - turned.T)[[2, 0, 1], [1, 2, 0]]
        return np.asarray(self.rows.T @ np.concatenate([self.stiffness[:3] * (self.rows[:3] @ q), axial]))

    def tangent(self, q: Array) -> Array:
        """(N, N): its second change."""
        turned = self._turned(q)
        turns = np.trace(turned) * np.eye(3) - 0.5 * (turned + turned.T)
        moves, spins = self.rows[:3], self.rows[3:]
        return np.asarray(moves.T @ (self.stiffness[:3, None] * moves) + spins.T @ turns @ spins)

    def _turned(self, q: Array) -> Array:
        """R A (3, 3)."""
        by_axis = self.stiffness[3:]
        return rotation(self.rows[3:] @ q) @ np.diag(0.5 * by_axis.sum() - by_axis)
