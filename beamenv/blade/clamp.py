"""Patches where a beam is least a beam: next to its clamp.

By Saint-Venant's principle a patch acts through its section's stress resultants alone from about a section's depth away. Nearer to
the clamp, which holds the section's shape, it does not quite. At the clamp of the thesis' blade the beam has up to 12 % (lag) and
7 % (flap) less static tip deflection per volt than solid elements, and drives the first eight modes by up to 7 % too little or too
much; in the thesis' model by up to 110 %.
"""

from __future__ import annotations

from collections.abc import Sequence

from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, Side, positions_of

_SOLID = {"blade": "by up to 7 %", "thesis": "by up to 110 %"}


def clamp_note(config: BladeConfig, sides: Sequence[Side] = SIDES) -> str:
    """One sentence on the patches of some sides that begin nearer to the clamp than the section is deep; empty if none does."""
    depth = config.beam.root_section.least_extent
    near = [f"{side[:-1]} at {z:.4g} m" for side in sides for z in positions_of(config, side) if z < depth * (1.0 - 1e-9)]
    if not near:
        return ""
    return (
        f"Nearer to the clamp than the section is deep ({depth:.4g} m): {', '.join(near)}; what patches do there differs from "
        f"solid elements {_SOLID[config.model]}, mode by mode."
    )
