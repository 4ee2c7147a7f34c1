"""What ``info`` holds."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.simulation.motion import Motion

Array = NDArray[np.float64]

INFO = ("volts", "tip_displacement", "energy", "effort", "cost_increment")
"""What info holds of a ``Motion``."""

STEADY_INFO = ("static_stretch", "static_untwist", "static_strain", "static_strain_at")
"""What a reset's info holds besides, of the blade as it turns and nothing vibrates."""


def steady_information(steady: Array, note: Any, assumed: Any) -> dict[str, Any]:
    """What a reset's info holds beside ``information``: of steady states (…, 4), as ``Bank`` has them, a note (…) and what was
    ``assumed`` (…) of a model of one's own.
    """
    return {**dict(zip(STEADY_INFO, np.moveaxis(steady, -1, 0), strict=True)), "note": note, "assumed": assumed}


def information(motion: Motion) -> dict[str, Any]:
    """The info arrays of a motion, by the names in ``INFO``."""
    return {
        "volts": motion.volts,
        "tip_displacement": motion.tip_displacement,
        "energy": motion.energy,
        "effort": motion.effort,
        "cost_increment": motion.cost_increment,
    }
