"""Presets of blades and tiers of information, in a line each: for whoever lists or checks names without building anything."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

BLADES: Mapping[str, str] = MappingProxyType(
    {
        "thesis": "The thesis' box of 30° plies, pretwisted by 30°, at 200 rad/s; four MFC actuators over four sensors.",
        "sound-blade": "The same box as a blade that could be built: plies at ±75°, 100 rad/s, a limit on the total strain.",
        "thesis-untwisted": "The thesis' box without pretwist, as in its Figs. 5.10 to 5.12.",
        "thesis-pretwisted": "The thesis' box with 30° of presetting too, as in its Figs. 5.2 and 5.7.",
        "chandra-chopra": "The CAS box of the thesis' Table 3.2 at 1000 rev/min, with 7 mm wide MFC.",
        "aluminium-cantilever": "A 300 mm strip of aluminium on a bench, a sheet of PIC255 on either face; it does not turn.",
        "takacs-beam": "The 550 mm cantilever of Takács and Rohaľ-Ilkiv: piezoceramic wafers drive it, a laser reads its tip.",
        "airfoil-blade": "A hollow NACA 0012, 1.3 m long, with one web, at 72 rad/s; four MFC on either side.",
    }
)
"""Of the presets, in their order."""

TIERS: Mapping[int, str] = MappingProxyType(
    {0: "the nominal plant", 1: "the scenario's distribution", 2: "further measurements", 3: "the episode's truth"}
)
"""What a controller of each tier knows besides what lower ones do."""

LEARNT = 1
"""The tier of agents: what they train on is the scenario's distribution, and they see the readings alone."""
