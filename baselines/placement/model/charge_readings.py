"""Layouts whose sensors are read by their charges: what a reading shows of displacements, in place of the currents of velocities.

With x = [Ω η; η̇] a current is [0, c] x and a charge [c Ω⁻¹, 0] x. What modes left out add is in proportion to voltages that are
known, and of no consequence to the filter's error.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.reduced_slopes import ReducedSlopes
from beamenv.plant.reduction import ReducedBlades

Array = NDArray[np.float64]


def reading_charges(blades: ReducedBlades) -> ReducedBlades:
    """The blades with rows of charges, C per √J, in place of those of currents."""
    return replace(blades, output=_of_displacements(_charges(blades.output) / blades.natural_frequencies[..., None, :]))


def charge_slopes(blades: ReducedBlades, slopes: ReducedSlopes) -> ReducedSlopes:
    """The slopes with those of charges; ``blades`` is the one layout as it was, read by currents. dΩ is symmetric, not diagonal."""
    c, omega = _charges(blades.output)[0], blades.natural_frequencies[0]
    r = len(omega)
    turned = (c / omega) @ slopes.dynamics[:, :r, r:]
    return replace(slopes, output=_of_displacements((_charges(slopes.output) - turned) / omega))


def _charges(output: Array) -> Array:
    """(…, s, r), C per unit of each modal coordinate."""
    return output[..., output.shape[-1] // 2 :]


def _of_displacements(rows: Array) -> Array:
    return np.concatenate([rows, np.zeros_like(rows)], axis=-1)
