"""The amplitudes of a section's shapes: how many there are, and what one of 1 means in every section of a blade."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.section.central_solution import CentralSolution, Factorised, equilibrium
from beamenv.structure.section.distortion import DISTORTIONS, loads_of_bimoment, loads_of_vibrations
from beamenv.structure.section.elements import RIGID

Array = NDArray[np.float64]

AMPLITUDES = RIGID + DISTORTIONS
"""Shapes a section may take beside its rigid motion."""

STRAINS = RIGID + 2 * AMPLITUDES
"""Of a section: (γx, γy, w′, θx′, θy′, φ′), the amplitudes of its shapes, and their derivatives along the span."""

SHEAR_AND_TWIST = np.array([0, 1, 5])
"""Of the beam strains γx, γy and φ′, and of the resultants Vx, Vy and Mz."""


@dataclass(frozen=True, slots=True, eq=False)
class Meaning:
    """What amplitudes of 1 mean in all sections of a blade."""

    resultants: Array
    """(6,): in the first section of unit energy."""
    loads: Array
    """Those that distort, (1, K, size, DISTORTIONS)."""
    strains: Array | None
    """(3, 3): of an open section, shear and twist of the first under these resultants of them; None: closed."""

    @classmethod
    def of(cls, first: Factorised, central: CentralSolution, opened: bool) -> Meaning:
        """That of a blade whose first section this is."""
        loads, resultants = loads_of_vibrations(first), np.sqrt(np.diagonal(central.stiffness[0]))
        if not opened:
            return cls(resultants, loads, None)
        torsion = central.warping[:1, :, :, RIGID - 1 :]
        loads = np.concatenate([loads_of_bimoment(first, torsion), loads], axis=-1)[..., :DISTORTIONS]
        return cls(resultants, loads, (central.strain[0] * resultants)[np.ix_(SHEAR_AND_TWIST, SHEAR_AND_TWIST)])

    def shapes(self, central: CentralSolution) -> tuple[Array, Array]:
        """Saint-Venant's shapes of each section, and their amplitudes (V, 6, 6) per stress resultant.

        Warping must go on from one section to the next where a patch begins. In torsion, and under forces beside the shear centre,
        that of an open section is large and goes with twist and shear, not with torque and forces: of two sections of unlike
        stiffness it is alike where these are. Otherwise, and of a closed section, amplitudes go with the resultants: under a patch
        that bends no moment acts, and nothing jumps at its ends.
        """
        if self.strains is None:
            per_resultant = np.broadcast_to(np.diag(1.0 / self.resultants), central.strain.shape)
            return central.warping * self.resultants, per_resultant
        resultants = np.tile(np.diag(self.resultants), (len(central.strain), 1, 1))
        own = np.ix_(np.arange(len(resultants)), SHEAR_AND_TWIST, SHEAR_AND_TWIST)
        resultants[own] = np.linalg.solve(central.strain[own], np.broadcast_to(self.strains, resultants[own].shape))
        return central.warping @ resultants[:, None], np.asarray(np.linalg.inv(resultants))


def saint_venant_strains(central: CentralSolution, amplitudes: Array, pretwist: float) -> Array:
    """(V, STRAINS, 6): strains of sections per stress resultant, far from clamp and patches."""
    state = np.zeros((len(central.strain), STRAINS, RIGID))
    state[:, :RIGID] = central.strain
    state[:, RIGID : 2 * RIGID] = amplitudes
    state[:, RIGID + AMPLITUDES : 2 * RIGID + AMPLITUDES] = amplitudes @ equilibrium(pretwist)
    return state
