"""Patch layouts that only the thesis has: other sheets than the data sheet's, and patches that reach the tip."""

from __future__ import annotations

from dataclasses import dataclass, replace

from beamenv.patches import MFC, PatchLayout, PatchMaterial

PRINTED_DENSITY = replace(MFC, lamina=replace(MFC.lamina, density=8528.0))
"""The thesis' MFC: it prints the part number (M-8528) where the density belongs."""

FIELD_OVER_THICKNESS = replace(MFC, electrode_spacing=MFC.thickness)
"""An MFC whose field is V/thickness, as Eq. 5.2 has it, where it is V/electrode spacing."""


@dataclass(frozen=True)
class SheetLayout(PatchLayout):
    """Patches of a sheet that no table of ours holds."""

    sheet: PatchMaterial = MFC

    @property
    def patch(self) -> PatchMaterial:
        """The sheet given."""
        return self.sheet


@dataclass(frozen=True)
class CoveringLayout(PatchLayout):
    """One actuator over one sensor from the root on, of any length up to the whole span."""

    def actuator_positions(self, beam_length: float) -> tuple[float, ...]:
        """At the root."""
        return (0.0,)

    def sensor_positions(self, beam_length: float) -> tuple[float, ...]:
        """At the root."""
        return (0.0,)
