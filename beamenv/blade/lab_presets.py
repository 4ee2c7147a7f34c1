"""Blades that lie on benches: an aluminium strip with piezoceramic sheets, and a slender airfoil with macro-fibre composite."""

from __future__ import annotations

from beamenv.blade.config import ON_EVERY_WALL, BeamConfig, BladeConfig
from beamenv.patches import PatchLayout
from beamenv.patches.group import PatchGroup
from beamenv.structure.section.airfoil import AirfoilSection
from beamenv.structure.section.open_sections import StripSection
from beamenv.structure.section.webs import Web


def _sheet(face: str) -> PatchGroup:
    return PatchGroup(positions=(0.01,), material="PIC255", length=0.05, width=0.025, wall="strip", face=face, bonded=True)


ALUMINIUM_CANTILEVER = BladeConfig(
    beam=BeamConfig(
        length=0.3,
        section=StripSection(width=0.03, thickness=0.002),
        material="aluminium",
        ply_angles_deg=((ON_EVERY_WALL, (0.0,)),),
        hub_radius=0.0,
        pretwist_deg=0.0,
    ),
    patches=PatchLayout(actuators=(_sheet("outer"),), sensors=(_sheet("inner"),)),
    speed=0.0,
    modes=5,
    damping_ratio=0.005,
    voltage_limits=(-150.0, 150.0),
)
"""300 × 30 × 2 mm of aluminium, clamped; 10 mm from the clamp a sheet of PIC255, 50 × 25 × 0.5 mm, bonded to either face: the upper
one bends it, the lower one is read. ±150 V are 0.3 kV/mm, what the maker lets a soft piezoceramic bear against its poling."""


def _fibres(wall: str) -> PatchGroup:
    return PatchGroup(positions=4, material="MFC", length=0.085, width=0.028, wall=wall, outermost=0.7)


AIRFOIL_BLADE = BladeConfig(
    beam=BeamConfig(
        length=1.3,
        section=AirfoilSection(chord=0.1077, thickness=0.001, profile="NACA 0012", trailing_edge=0.9, webs=(Web(0.4),)),
        material="as4-3501-6",
        ply_angles_deg=((ON_EVERY_WALL, (90.0, 45.0, -45.0, -45.0, 45.0, 90.0)),),
        hub_radius=0.1,
        pretwist_deg=-10.0,
    ),
    patches=PatchLayout(actuators=(_fibres("top"),), sensors=(_fibres("bottom"),)),
    speed=72.0,
    voltage_limits=(-500.0, 1500.0),
    strain_limit="total",
)
"""A hollow NACA 0012 of graphite-epoxy, 1 mm thick, with a web at 0.4 of its width, of about the size of a rotor in a wind tunnel
(chord 0.108 m, radius 1.4 m, as NASA's Active Twist Rotor); four MFC (85 × 28 mm, the M-8528-P1) let into its upper side bend it,
four in its lower side are read."""
