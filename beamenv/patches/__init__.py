"""Piezoelectric patches: their material, their layout on the blade, actuation and sensing (thesis chapter 4)."""

from beamenv.patches.layout import PatchLayout
from beamenv.patches.material import MFC, PATCH_MATERIALS, PZT, PatchMaterial
from beamenv.patches.operators import actuation, force_per_span, patch_force, sensing

__all__ = ["MFC", "PATCH_MATERIALS", "PZT", "PatchLayout", "PatchMaterial", "actuation", "force_per_span", "patch_force", "sensing"]
