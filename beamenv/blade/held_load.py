"""What line load the patches of a blade can hold, and the reference load that goes by it: the size of what happens to a blade.

A uniform line load moves the tip somewhere, and voltages at their limits can take it back as far as they move it that way; the
load at which both are equal is held. How large it is depends on where the load points to: a patch on its face bends a strip over,
and not edgewise.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.configuration import Refused
from beamenv.plant.plant import Plant, drive_limit
from beamenv.plant.signals import REFERENCE_LOAD

Array = NDArray[np.float64]

TIMES_HELD = 5.0
"""The reference load over the load that is held: it is 4.9 times as large on the default blade, 30 N/m over 6.1 N/m."""


def held_load(plant: Plant) -> float:
    """N/m: the line load whose tip displacement voltages at their limits can undo.

    Of the two directions across each other in which a line load moves the tip the most and the least (the right singular vectors of
    the tip displacement by the line loads), the one in which more is held.
    """
    loaded, driven = (-plant.tip_displacement @ np.linalg.solve(plant.A, each) for each in _pushes(plant))
    ways, far, _ = np.linalg.svd(loaded)
    return float((np.abs(ways.T @ driven).sum(axis=1) / far).max())


def _pushes(plant: Plant) -> tuple[Array, Array]:
    return plant.disturbance_input, plant.B * drive_limit(plant)


def own_reference(config: BladeConfig) -> float | None:
    """N/m: the reference load that a configuration says, or 30 for a box of the thesis' size, whatever its patches; None: as
    much as they make of it.
    """
    if config.reference_load is not None:
        return config.reference_load
    return REFERENCE_LOAD if _thesis_sized(config.beam) else None


def under_reference(config: BladeConfig, load: float) -> BladeConfig:
    """The configuration under a reference load (N/m), whatever its patches can hold."""
    return config if own_reference(config) == load else replace(config, reference_load=load)


def _thesis_sized(beam: BeamConfig) -> bool:
    own = BeamConfig()
    return all(getattr(beam, name) == getattr(own, name) for name in ("section", "length", "width", "depth", "thickness"))


def reference_of(plant: Plant) -> float:
    """N/m: ``TIMES_HELD`` what is held; ``ValueError`` where the patches do not move the tip at all."""
    held = held_load(plant)
    if not (np.isfinite(held) and held > 0.0):
        raise Refused("blade.reference_load", None, "a number (N/m) where the patches hold no load")
    return TIMES_HELD * held
