"""How large a blade's parts may be: what none has was given in another unit."""

from __future__ import annotations

from beamenv.configuration import Number

LONGEST = 250.0
"""m: the longest rotor blades, of wind turbines, have some 150."""

WIDEST = 20.0
"""m: the chord of those is below 8."""

THICKEST = 0.25
"""m, of a wall or a solid strip: at the root of those, laminates are 0.15 thick."""

SPAN = Number(gt=0.0, le=LONGEST, unit="m")
HUB = Number(ge=0.0, le=LONGEST, unit="m")
WIDTH = Number(gt=0.0, le=WIDEST, unit="m")
WALL = Number(gt=0.0, le=THICKEST, unit="m")
SHEET = Number(gt=0.0, le=0.02, unit="m")
"""Of a piezoelectric sheet: they have tenths of a millimetre, stacked plates some."""
