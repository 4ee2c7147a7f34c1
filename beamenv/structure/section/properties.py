"""What a section is worth to a beam."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import Sealed
from beamenv.structure.section.solid_sections import SolidSections

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class SectionProperties(Sealed):
    """What a section is worth to a beam, about the origin of its corners."""

    stiffness: Array
    """(6, 6) for (γx, γy, w', θx', θy', φ'): rows Vx, Vy, N, Mx, My, Mz; N, N m, N m²."""
    classical_stiffness: Array
    """(4, 4) for (w', θx', θy', φ'), the transverse shear condensed out."""
    tension_centre: Array
    """(2,), m: an axial force there bends the section in neither direction."""
    shear_centre: Array
    """(2,), m: a transverse force there does not twist the section."""
    mass_per_length: float
    """kg/m."""
    mass_centre: Array
    """(2,), m."""
    second_moments: Array
    """(2, 2), kg m: ∫ρ (x, y)ᵀ(x, y) dA."""

    @classmethod
    def of(cls, solid: SolidSections) -> SectionProperties:
        """The first of some solid sections."""
        mass, x, y, xx, xy, yy = solid.inertia[0]
        return cls(
            stiffness=solid.stiffness[0],
            classical_stiffness=solid.classical_stiffness[0],
            tension_centre=solid.tension_centre[0],
            shear_centre=solid.shear_centre[0],
            mass_per_length=float(mass),
            mass_centre=np.array([x, y]) / mass,
            second_moments=np.array([[xx, xy], [xy, yy]]),
        )
