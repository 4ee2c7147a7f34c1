"""Piezoelectric patches: their material, their layout on the blade, actuation and sensing (thesis chapter 4)."""

from beamenv.patches.group import PatchGroup
from beamenv.patches.layout import PatchLayout
from beamenv.patches.material import MFC, PATCH_MATERIALS, PZT, PatchMaterial
from beamenv.patches.operators import PatchResponse, actuation, force_per_span, local_response, patch_force, sensing

__all__ = [
    "MFC",
    "PATCH_MATERIALS",
    "PZT",
    "PatchGroup",
    "PatchLayout",
    "PatchMaterial",
    "PatchResponse",
    "actuation",
    "force_per_span",
    "local_response",
    "patch_force",
    "sensing",
]
