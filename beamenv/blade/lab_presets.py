"""Blades that lie on benches: aluminium strips with piezoceramic sheets, one of them published, and an airfoil with macro-fibre."""

from __future__ import annotations

from beamenv.blade.config import ON_EVERY_WALL, BeamConfig, BladeConfig
from beamenv.patches import PatchLayout
from beamenv.patches.group import PatchGroup
from beamenv.patches.material import CERAMIC_STRENGTH, PatchMaterial
from beamenv.sensors.kinds import Displacement
from beamenv.structure import Lamina
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

_WAFER = PatchMaterial(
    lamina=Lamina.isotropic(E=1.0 / 16.4e-12, nu=5.74 / 16.4, density=7700.0),
    d11=-179e-12,
    d12=-179e-12,
    thickness=0.25e-3,
    electrode_spacing=0.25e-3,
    failure_strain=CERAMIC_STRENGTH * 16.4e-12,
)


def _wafers(face: str, positions: tuple[float, ...], ganged: bool = False) -> PatchGroup:
    return PatchGroup(
        positions=positions, material=_WAFER, length=0.044, width=0.02, wall="strip", face=face, bonded=True, ganged=ganged
    )


TAKACS_BEAM = BladeConfig(
    beam=BeamConfig(
        length=0.55,
        section=StripSection(width=0.04, thickness=0.003),
        material=Lamina.isotropic(E=68e9, nu=0.33, density=2691.7),
        ply_angles_deg=((ON_EVERY_WALL, (0.0,)),),
        hub_radius=0.0,
        pretwist_deg=0.0,
    ),
    patches=PatchLayout(
        actuators=(_wafers("outer", (0.014, 0.09), ganged=True),),
        sensors=(_wafers("inner", (0.014,)), _wafers("outer", (0.322,))),
    ),
    speed=0.0,
    modes=5,
    damping_ratio=0.0062,
    voltage_limits=(-120.0, 120.0),
    sensors=(Displacement(),),
    control_interval=0.01,
)
"""The cantilever that Takács and Rohaľ-Ilkiv control (Direct closed-loop active vibration control system prototyping in ANSYS,
NOVEM 2012; Model Predictive Vibration Control, Springer 2012), from the files that Takács publishes of it (MIT licence,
github.com/gergelytakacs/vibration-control-ANSYS): 550 × 40 × 3 mm of aluminium with four wafers of piezoceramic (QP16n), 44 × 20 ×
0.25 mm; those 14 and 90 mm from the clamp are driven by one voltage of ±120 V, and the tip is read, 100 times a second. The other
two, under the first and 322 mm from the clamp, are idle there and here; with ``sensors`` empty they are read.

Measured are the poles and the gain of the model with two states that its controller has (n4s2s: n4sid, at 100 Hz): 8.17 Hz, a
damping ratio of 0.62 %, and 1.89 μm at the tip per volt in the first mode. What follows here is 8.40 Hz, 2.9 % more, and 2.30
μm/V, 21 % more. By finite elements of a plate it is 2.16 μm/V, 14 % more; wafers not much longer than a beam is wide bend it by 6
% more than that (docs/sections.md). What of the 14 % comes from clamp and adhesive, which are ideal here, from the wafers'
packing, which is left out, and from wafers weaker than their maker's numbers, is not told apart. Further: every mode has the
damping of the first; two wafers are in truth 1 mm off the middle of the width (the files say); the modulus, 68 GPa, is that of the
authors' finite elements (a handbook's 69 GPa would be 3.6 % more), which may owe something to the measurement."""


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
