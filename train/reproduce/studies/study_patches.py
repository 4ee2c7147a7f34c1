"""Patches that only the thesis has: other sheets than the data sheet's, and patches that reach the tip."""

from __future__ import annotations

from dataclasses import replace

from beamenv.patches import MFC, PatchGroup, PatchLayout
from beamenv.patches.layout import SIDES, WALLS

PRINTED_DENSITY = replace(MFC, lamina=replace(MFC.lamina, density=8528.0))
"""The thesis' MFC: it prints the part number (M-8528) where the density belongs."""

FIELD_OVER_THICKNESS = replace(MFC, electrode_spacing=MFC.thickness)
"""An MFC whose field is V/thickness, as Eq. 5.2 has it, where it is V/electrode spacing."""


def covering(length: float, width: float) -> PatchLayout:
    """One actuator over one sensor from the root on, of any ``length`` (m) up to the whole span."""
    actuators, sensors = ((PatchGroup((0.0,), length=length, width=width, wall=WALLS[side]),) for side in SIDES)
    return PatchLayout(actuators, sensors)
