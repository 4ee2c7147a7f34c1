"""Piezoelectric patches: their material, their layout on the blade, actuation and sensing (thesis chapter 4)."""

from beamenv.patches.layout import PatchLayout
from beamenv.patches.material import MFC, PATCH_MATERIALS, PZT, PatchMaterial
from beamenv.patches.operators import actuation, patch_force, sensing

__all__ = ["MFC", "PATCH_MATERIALS", "PZT", "PatchLayout", "PatchMaterial", "actuation", "patch_force", "sensing"]
