"""Materials by name: composites and metals of blades, and the metals and ceramics that walls are graded between."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from beamenv.structure.walls.curves import ROOM, Touloukian
from beamenv.structure.walls.materials import FOLLOWED, Lamina

EPOXY_GLASS_TRANSITION = 472.0
"""K: of dry epoxies of structural composites, typically (NASA, Resin Systems and Chemistry: Degradation Mechanisms and Durability
in Long-Term Durability of Polymeric Matrix Composites, 2013)."""


def _softening(glass_transition_K: float) -> tuple[tuple[float, float], ...]:
    """√((T_g − T)/(T_g − 300 K)): a dry resin's modulus over that at 300 K (Chamis, NASA TM-83320, 1983), in steps of 20 K."""
    temperatures = np.arange(200.0, 381.0, 20.0)
    shares = np.sqrt((glass_transition_K - temperatures) / (glass_transition_K - ROOM))
    return tuple(zip(temperatures.tolist(), shares.tolist(), strict=True))


GRAPHITE_EPOXY = Lamina(
    E1=206.8e9, E2=5.17e9, G12=3.1e9, G13=3.1e9, G23=2.5511e9, nu12=0.25, density=1528.15, alpha1=-0.5e-6, alpha2=32e-6,
    curves=dict.fromkeys(("E2", "G12", "G13", "G23"), _softening(EPOXY_GLASS_TRANSITION)),  # type: ignore[arg-type]
)  # fmt: skip
"""The thesis' blade (Table 5.1), which prints neither expansion nor what heat does. Expansion: that of high-modulus carbon fibres
in epoxy, 60 % by volume (Callister, Fundamentals of Materials Science and Engineering, Table B.6). Across the fibres and in shear
the ply softens as a dry resin does, along them not at all: within 10 % of the moduli that Sai Ram and Sinha take for a
graphite-epoxy from 300 to 375 K (Journal of Sound and Vibration 158, 1992)."""

AS4_3501_6 = Lamina(
    E1=141.93e9, E2=9.788e9, G12=6.135e9, G13=6.135e9, G23=4.8e9, nu12=0.42, density=1444.8, alpha1=-1e-6, alpha2=26e-6
)
"""The graphite-epoxy of Chandra and Chopra's box beams (Journal of Aircraft 29, 1992); expansion of AS4/3501-6 by Soden, Hinton and
Kaddour (Composites Science and Technology 58, 1998). No curves: no table of its moduli over temperature could be read."""

ALUMINIUM = Lamina.isotropic(
    E=68.9e9,
    nu=0.33,
    density=2700.0,
    alpha=22.9e-6,
    curves={
        "E1": (
            (100.0, 1.089), (150.0, 1.068), (200.0, 1.046), (250.0, 1.022), (293.15, 1.0), (323.15, 0.99), (373.15, 0.97),
            (423.15, 0.93), (473.15, 0.86),
        ),
        "alpha1": (
            (100.0, 18.94 / 22.9), (150.0, 20.61 / 22.9), (200.0, 21.78 / 22.9), (250.0, 22.46 / 22.9), (293.15, 1.0),
            (473.15, 24.7 / 22.9),
        ),
    },
)  # fmt: skip
"""6061-T6 (ASM Aerospace Specification Metals). Modulus and mean expansion from 20 °C over temperature: above it Eurocode 9 (EN
1999-1-2: 70, 69.3, 67.9, 65.1 and 60.2 GPa at 20, 50, 100, 150 and 200 °C; Δl/l = 22.5·10⁻⁶ θ + 0.1·10⁻⁷ θ² − 4.5·10⁻⁴), below
it the polynomials of NIST's cryogenic data of 6061-T6, over their value at 20 °C; expansions differ by 1 % where they meet."""


def _touloukian(E: tuple[float, ...], nu: tuple[float, ...], alpha: tuple[float, ...], density: float) -> Lamina:
    """From P0, P1, P2, P3 (those that are not zero) of modulus (Pa), Poisson's ratio and expansion (1/K)."""
    curves = [Touloukian(300.0, 1000.0, 0.0, *over) for _, *over in (E, nu, alpha)]
    constants = [curve.constant(P0) for curve, (P0, *_) in zip(curves, (E, nu, alpha), strict=True)]
    return Lamina.isotropic(constants[0], constants[1], density, constants[2], dict(zip(FOLLOWED, curves, strict=True)))


SUS304 = _touloukian((201.04e9, 3.079e-4, -6.534e-7), (0.3262, -2.002e-4, 3.797e-7), (12.330e-6, 8.086e-4), 8166.0)
"""Stainless steel. This and the next five: Touloukian's coefficients as printed by Reddy and Chin (Journal of Thermal Stresses 21,
1998), whose constants here are those at 300 K, and taken to hold to 1000 K."""

SILICON_NITRIDE = _touloukian((348.43e9, -3.070e-4, 2.160e-7, -8.946e-11), (0.24,), (5.8723e-6, 9.095e-4), 2370.0)
"""Si3N4."""

TI_6AL_4V = _touloukian((122.56e9, -4.586e-4), (0.2884, 1.121e-4), (7.5788e-6, 6.638e-4, -3.147e-6), 4420.0)
"""Titanium with 6 % of aluminium and 4 % of vanadium; its expansion falls beyond 300 K only as the polynomial has it."""

ZIRCONIA = _touloukian(
    (244.27e9, -1.371e-3, 1.214e-6, -3.681e-10), (0.2882, 1.133e-4), (12.766e-6, -1.491e-3, 1.006e-5, -6.778e-11), 3000.0
)
"""ZrO2, with the density that is printed beside the coefficients; dense zirconia weighs nearly twice as much."""

ALUMINA = _touloukian((349.55e9, -3.853e-4, 4.027e-7, -1.673e-10), (0.26,), (6.8269e-6, 1.838e-4), 3800.0)
"""Al2O3."""

MATERIALS: Mapping[str, Lamina] = MappingProxyType(
    {
        "graphite-epoxy": GRAPHITE_EPOXY,
        "as4-3501-6": AS4_3501_6,
        "aluminium": ALUMINIUM,
        "sus304": SUS304,
        "silicon-nitride": SILICON_NITRIDE,
        "ti-6al-4v": TI_6AL_4V,
        "zirconia": ZIRCONIA,
        "alumina": ALUMINA,
    }
)
