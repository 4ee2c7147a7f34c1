"""Piezoelectric sheets: macro-fibre composite (MFC, d33 effect along the fibres) and monolithic PZT (d31 effect)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Refused, checked, configuration
from beamenv.structure.sizes import SHEET
from beamenv.structure.walls.curves import DATA_KELVIN, ROOM
from beamenv.structure.walls.inlay import Inlay
from beamenv.structure.walls.laminate import Ply, power_integrals
from beamenv.structure.walls.materials import Lamina, strain_rotation

Array = NDArray[np.float64]

MFC_STRAIN = 0.0045
"""The greatest tensile strain an MFC is rated for (4500 ppm, Smart Material's data sheet); the laminate beneath breaks later."""

CERAMIC_STRENGTH = 140.4e6
"""N/m²: at which bare sheets of PZT-5A break in three-point bending (Anton, Erturk and Inman, Bending Strength of Piezoelectric
Ceramics and Single Crystals for Multifunctional Load-Bearing Applications, IEEE Trans. UFFC 59, 2012)."""

FIBRE_ANGLE_DEG = 90.0
"""Fibres run along the span. The thesis prints θp = 0, which would leave −1.1 C/m² along the span and is not meant."""


VACUUM = 8.8541878128e-12
"""F/m."""

COLDEST = 173.15
"""K: below, nothing is known of any sheet."""

FreeStrain = Number(ge=-1e-6, le=1e-6, unit="m/V")
"""Hundreds of times what single crystals do, and far below any number of pC/N or nm/V."""


@configuration("patch_material")
class PatchMaterial:
    """A piezoelectric sheet driven by one field E = V / ``electrode_spacing`` along its axis 1 (MFC) or through it (PZT)."""

    lamina: Lamina
    d11: Annotated[float, FreeStrain]
    """Free strain along the span per field, m/V (= C/N)."""
    d12: Annotated[float, FreeStrain]
    """Free strain across the span per field, m/V."""
    thickness: Annotated[float, SHEET]
    """m."""
    electrode_spacing: Annotated[float, SHEET]
    """m: between the fingers of an MFC's electrodes, the thickness of a PZT sheet."""
    failure_strain: Annotated[float, Number(gt=0.0, le=1.0, unit="m/m")] = MFC_STRAIN
    """At which it breaks, m/m; an MFC's unless said otherwise. The least of a blade's sheets ends its episodes."""
    permittivity: Annotated[float | None, Number(ge=VACUUM, le=1e5 * VACUUM, unit="F/m")] = None
    """F/m of a sheet free of stress, as its electrodes find it: its capacitance is that times volume over spacing²."""
    permittivity_per_K: Annotated[float, Number(ge=-0.02, le=0.02, unit="1/K")] = 0.0
    """By which share of it at 300 K the permittivity ε rises per K. Free strain per field, k √(ε s), rises as its root: coupling
    factor k and compliance s hardly change."""
    warmest: Annotated[float | None, Number(gt=0.0, le=2000.0, unit="K")] = None
    """Up to which temperature it may be used; None: any, at which it is as at 300 K."""
    pyroelectric: Annotated[float, Number(ge=-1.0, le=1.0, unit="C/m²K")] = 0.0
    """Charge per area and K of a sheet free to expand."""

    def at(self, temperature_K: float) -> PatchMaterial:
        """The sheet at a temperature; ``ValueError`` beyond its data, or where it would lose its polarisation."""
        temperature_K = checked("temperature", temperature_K, DATA_KELVIN)
        highest = np.inf if self.warmest is None else self.warmest
        if not COLDEST <= temperature_K <= highest:
            raise Refused(
                "temperature", temperature_K, f"a number from {COLDEST:g} to {highest:g} (K), as hot as its patches may be"
            )
        share = 1.0 + self.permittivity_per_K * (temperature_K - ROOM)
        if share <= 0.0:
            per_K = self.permittivity_per_K
            raise Refused("temperature", temperature_K, f"one at which permittivity_per_K = {per_K:g} leaves some permittivity (K)")
        strained, stored = float(np.sqrt(share)), None if self.permittivity is None else share * self.permittivity
        lamina = self.lamina.at(temperature_K)
        warm = replace(self, lamina=lamina, d11=strained * self.d11, d12=strained * self.d12, permittivity=stored)
        return replace(warm, permittivity_per_K=0.0, warmest=None)

    def piezoelectric_stress(self) -> Array:
        """E = d Q (2,): stress along and across the axis 1 per field under plane stress, C/m²."""
        return np.asarray((self.lamina.reduced_stiffness() @ np.array([self.d11, self.d12, 0.0]))[:2])

    def free_strain(self, voltage: float) -> float:
        """Strain along the span of an unloaded sheet."""
        return self.d11 * voltage / self.electrode_spacing

    def capacitance(self, area: float) -> float:
        """F of a sheet of so many m², free of stress; ``ValueError`` where its permittivity is unknown."""
        if self.permittivity is None:
            raise Refused("patch_material.permittivity", None, "known (F/m) where capacitances are asked for")
        return self.permittivity * area * self.thickness / self.electrode_spacing**2

    def stress_in_wall(self, angle_deg: float = FIBRE_ANGLE_DEG) -> Array:
        """(3,): piezoelectric stress in the wall's (ss, zz, sz) per field, C/m², with axis 1 turned from s towards z."""
        along, across = self.piezoelectric_stress()
        return np.asarray(strain_rotation(np.radians(angle_deg)).T @ np.array([along, across, 0.0]))

    def wall_resultants(self, wall_thickness: float, hoop_coupling: Array, angle_deg: float = FIBRE_ANGLE_DEG) -> Array:
        """(…, 6) piezoelectric resultants per volt, conjugate to (ε0, ε1, ε3, γ0, γ1, γ2), of a sheet flush with the outer face.

        ``hoop_coupling`` (…, 6) is the wall law's: the hoop stress acts on the resultants through it, since N_ss = 0.
        """
        outer = 0.5 * wall_thickness
        moments = power_integrals(np.array([outer - self.thickness, outer]), 3)[:, 0] / self.electrode_spacing
        hoop, span, shear = self.stress_in_wall(angle_deg)
        direct = np.concatenate([span * moments[[0, 1, 3]], shear * moments[[0, 1, 2]]])
        return direct - hoop_coupling * (hoop * moments[0])

    @property
    def charge_per_reaction(self) -> float:
        """Charge that Eq. 4.37, ∫ē ε dA, counts per unit of generalised force per volt times displacement: spacing/thickness."""
        return self.electrode_spacing / self.thickness

    def inlay(
        self,
        wall: str,
        start: float,
        length: float,
        width: float,
        offset: float = 0.0,
        face: str = "outer",
        bonded: bool = False,
        angle_deg: float = FIBRE_ANGLE_DEG,
    ) -> Inlay:
        """The sheet as foreign material in a wall, or on it: its passive effect."""
        ply = Ply(self.lamina, angle_deg)
        return Inlay(wall, start, length, width, ply, self.thickness, offset, face, bonded)


EXPANSION = 3.0e-6
"""1/K, across the polarisation: CTS' 3195, a PZT-5A (data sheet)."""

SOFT = 4e-3
"""1/K: the permittivity's coefficient of PIC255, −20 … 125 °C (PI Ceramic's data); taken for other soft PZT too."""

PYROELECTRIC = -4e-4
"""C/m²K: typical of PZT, whose polarisation falls with heat."""

MFC = PatchMaterial(
    lamina=Lamina(
        E1=30.4e9, E2=15.86e9, G12=5.52e9, G13=5.52e9, G23=5.52e9, nu12=0.31, density=5440.0, alpha1=3.4e-6, alpha2=12.7e-6
    ),
    d11=460e-12,
    d12=-210e-12,
    thickness=0.3e-3,
    electrode_spacing=0.5e-3,
    failure_strain=MFC_STRAIN,
    permittivity=3.0e-6 * (0.5e-3) ** 2 / 0.3e-3,
    permittivity_per_K=SOFT,
    warmest=403.15,
    pyroelectric=PYROELECTRIC,
)
"""M-8557-P1 (thesis Table 5.1; density from the data sheet, the thesis prints the part number). Its poled capacitance is 0.30
nF/cm² (Smart Material, MFC Engineering Properties): 14.5 nF. It may be used up to 130 °C in its version for high temperatures, else
to 85 °C, and from −35 °C on, below which its data are drawn out. Expansion: Schapery's formulas (Journal of Composite Materials 2,
1968) for 86 % of PZT-5A in epoxy of 3 GPa and 55·10⁻⁶/K, no measured one was found."""

PZT = PatchMaterial(
    lamina=Lamina(E1=124e9, E2=130e9, G12=70e9, G13=70e9, G23=74e9, nu12=0.25, density=8000.0, alpha1=EXPANSION, alpha2=EXPANSION),
    d11=-140e-12,
    d12=-140e-12,
    thickness=0.3e-3,
    electrode_spacing=0.3e-3,
    failure_strain=CERAMIC_STRENGTH / 124e9,
    permittivity=1700.0 * VACUUM,
    permittivity_per_K=SOFT,
    warmest=448.15,
    pyroelectric=PYROELECTRIC,
)
"""Monolithic sheet poled through its thickness: d31 in both directions (thesis Table 5.1). It breaks at 0.113 %, the strength of
PZT-5A by its own modulus, which is twice that of PZT-5A; the permittivity
is that of PZT-5A, ε33/ε0 = 1700 free (Berlincourt, Krueger and Near, Properties of Piezoelectricity Ceramics, Morgan TP-226).
As of PIC255, half the Curie temperature of 350 °C is the most at which it may be used, as makers advise."""

PIC255 = PatchMaterial(
    lamina=Lamina.isotropic(E=1.0 / 16.1e-12, nu=0.34, density=7800.0, alpha=EXPANSION),
    d11=-180e-12,
    d12=-180e-12,
    thickness=0.5e-3,
    electrode_spacing=0.5e-3,
    failure_strain=CERAMIC_STRENGTH * 16.1e-12,
    permittivity=1750.0 * VACUUM,
    permittivity_per_K=SOFT,
    warmest=448.15,
    pyroelectric=PYROELECTRIC,
)
"""A soft piezoceramic, poled through a thickness of 0.5 mm: s11 = 16.1·10⁻¹² m²/N, d31 = −180 pm/V, ε33/ε0 = 1750 and density of PI
Ceramic's data; Poisson's ratio is that of soft PZT. It breaks at 0.226 %, by the strength of PZT-5A, another soft one."""

PATCH_MATERIALS: Mapping[str, PatchMaterial] = MappingProxyType({"MFC": MFC, "PZT": PZT, "PIC255": PIC255})
