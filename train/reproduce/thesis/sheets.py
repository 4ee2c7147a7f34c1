"""The thesis' MFC: the data sheet's, with what the thesis prints in place of it."""

from __future__ import annotations

from dataclasses import fields, replace

from beamenv.patches import MFC, PatchLayout
from beamenv.patches.group import PatchGroup, Positions
from beamenv.patches.layout import Groups
from beamenv.patches.material import PatchMaterial
from beamenv.structure.walls.materials import Lamina
from train.reproduce.thesis.as_printed import PrintedQ, PrintedQ12
from train.reproduce.thesis.equations import FIBRES_ACROSS, FIELD, MFC_DENSITY, PRINTED_Q, PRINTED_Q12, Reading

DENSITY = 8528.0
"""kg/m³: the thesis prints the part number (M-8528) where the density belongs."""

PLIES = {PRINTED_Q12: PrintedQ12, PRINTED_Q: PrintedQ}


def ply(material: Lamina, reading: Reading) -> Lamina:
    """A lamina with the Q̄ of a reading."""
    values = {each.name: getattr(material, each.name) for each in fields(Lamina)}
    return next((kind(**values) for name, kind in PLIES.items() if name in reading), material)


def across(sheet: PatchMaterial) -> PatchMaterial:
    """The same sheet with its fibres turned by 90°."""
    own = sheet.lamina
    turned = replace(own, E1=own.E2, E2=own.E1, nu12=own.nu12 * own.E2 / own.E1, G13=own.G23, G23=own.G13)
    return replace(sheet, lamina=turned, d11=sheet.d12, d12=sheet.d11)


def sheet(material: str | PatchMaterial, reading: Reading) -> str | PatchMaterial:
    """A sheet by a reading, which changes an MFC's alone."""
    found = MFC if material == "MFC" else material
    if isinstance(found, str) or (found.d11, found.d12) != (MFC.d11, MFC.d12):
        return material
    if MFC_DENSITY in reading:
        found = replace(found, lamina=replace(found.lamina, density=DENSITY))
    if FIELD in reading:
        found = replace(found, electrode_spacing=found.thickness)
    if FIBRES_ACROSS in reading:
        found = across(found)
    made = replace(found, lamina=ply(found.lamina, reading))
    return material if made == MFC else made


def layout_by(layout: PatchLayout, reading: Reading) -> PatchLayout:
    """A layout with the sheets of a reading."""
    actuators, sensors = (groups_by(given, reading) for given in (layout.actuators, layout.sensors))
    return replace(layout, material=sheet(layout.material, reading), actuators=actuators, sensors=sensors)


def groups_by(given: int | Positions | Groups, reading: Reading) -> int | Positions | Groups:
    """Groups of patches likewise; a number of patches or their positions stay as they are."""
    if isinstance(given, tuple) and given and isinstance(given[0], PatchGroup):
        return tuple(replace(group, material=sheet(group.material, reading)) for group in given if isinstance(group, PatchGroup))
    return given
