"""What heat does to a blade at the stations at which it is integrated.

The sections' strains e that make stress are those beyond the free ones, e_T. With the work ρ of balanced stresses on derivatives of
the amplitudes the energy of the shapes is ½ aᵀ K_aa a + aᵀ ∫ (Φᵀ E_ae + Φ′ᵀ E_a′e) (e − e_T) dz + aᵀ ∫ Φ′ᵀ ρ dz: in units in
which K_aa is 1 they are asked for Z (e − e_T) + g, g = L⁻¹ ∫ Φ′ᵀ ρ dz.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Refused
from beamenv.configuration.read_only import Sealed
from beamenv.structure.geometrically_exact.sections_along import SectionsAlong
from beamenv.structure.planform import Planform

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Heat:
    """How hot a blade is beside what it was made at: the mean of each section is in its planform."""

    reference: float
    """K: at which nothing is strained."""
    difference: float
    """K: temperature of the upper end of every section, at the greatest y, less that of the lower one; straight in between."""

    def buckles(self, planform: Planform) -> Refused:
        """What is said where no steady state is stable."""
        assert planform.temperatures is not None
        hot, path = {temperature for _, temperature in planform.temperatures}, "beam.temperature"
        within_reach = "where the blade neither buckles nor bends out of reach (K)"
        if hot == {self.reference}:
            return Refused(f"{path}_difference", self.difference, f"nearer to 0, {within_reach}")
        nearer = f"nearer to {self.reference:g} K, {within_reach}"
        if len(hot) > 1:
            return Refused(f"{path}_table", [list(each) for each in planform.temperatures], nearer)
        return Refused(path, hot.pop(), nearer)

    def rises(self, z: Array, sections: SectionsAlong) -> Array:
        """(S, HEATS): K at the sections' axes beyond the reference, and K per m along y."""
        low, high = np.moveaxis(sections.at(z, sections.solid.depths), -1, 0)
        slope = self.difference / (high - low)
        mean = sections.planform.temperature(z) - self.reference
        return np.stack([mean - slope * 0.5 * (high + low), slope], axis=-1)

    def face_strain(self, z: Array, sections: SectionsAlong) -> Array:
        """(S, F): spanwise strain at the faces by the warping that heat brings about."""
        return np.asarray((sections.at(z, sections.solid.face_strain_by_heat) @ self.rises(z, sections)[..., None])[..., 0])


@dataclass(frozen=True, slots=True, eq=False)
class FreeStrains(Sealed):
    """At S stations."""

    strain: Array
    """e_T (S, 6)."""
    onward: Array
    """ρ (S, AMPLITUDES)."""
    moments: Array
    """∫σ_zz (1, x, y, x², xy, y²) dA of the stresses in balance (S, 6)."""

    @classmethod
    def of(cls, z: Array, sections: SectionsAlong, heat: Heat) -> FreeStrains:
        """Of sections that are known to expand."""
        expansion, rises = sections.solid.expansion, heat.rises(z, sections)
        assert expansion is not None
        parts = (sections.at(z, each) for each in (expansion.strain, expansion.onward, expansion.moments))
        return cls(*((part @ rises[..., None])[..., 0] for part in parts))
