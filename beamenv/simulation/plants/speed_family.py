"""One blade over a range of rotor speeds: a plant for each speed, and what a state at one speed means at another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Number, Numbers, checked
from beamenv.plant.plant import Plant
from beamenv.simulation.plants.coordinates import between

Array = NDArray[np.float64]

_LEAST_IN_COMMON = 0.5
"""Smallest principal cosine between the retained modes of two speeds at which they still span much the same motions."""


@dataclass(frozen=True, slots=True, eq=False)
class SpeedFamily:
    """Plants of one blade at k speeds, behind the same instruments, and the coordinates that they have in common."""

    speeds: Array
    """(k,), rad/s, ascending."""
    plants: tuple[Plant, ...]
    """One for each speed, in the coordinates of its own modes."""
    from_common: Array
    """(k, n, n): takes a state in the common coordinates, those of the configuration's own speed, to each plant's."""


def speed_family(config: BladeConfig, speeds: Sequence[float] | ArrayLike) -> SpeedFamily:
    """The plants of ``config`` at ``speeds`` (rad/s), its sensors' range as fitted at its own speed.

    With modes ΨᵀMΨ = I at one speed and Ψ₀ at the configuration's own, a motion Ψ₀ η₀ has the coordinates η = ΨᵀMΨ₀ η₀; as states
    are [ωη; η̇], signs and order of the modes do not matter. Raises ValueError for speeds that do not ascend, lie beyond the
    critical speed, or are so far away that the retained modes are others.
    """
    given = (speeds,) if np.ndim(speeds) == 0 else speeds
    grid = np.array(checked("speeds", given, Numbers(Number(ge=0.0, unit="rad/s"), least=1)), dtype=np.float64)
    if np.any(np.diff(grid) <= 0.0):
        raise ValueError(f"speeds = {speeds!r} must be one or more numbers in rad/s, each greater than the one before")
    own = Blade(config).with_fixed_range()
    family = [own.changed(replace(own.config, speed=float(speed))) for speed in grid]
    return SpeedFamily(grid, tuple(each.plant for each in family), np.stack([_from_common(own, each) for each in family]))


def _from_common(own: Blade, other: Blade) -> Array:
    seen = between(own.modal, other)  # the blade is the same, and so are its trial functions
    modes = own.config.modes
    least = np.linalg.svd(seen[modes:, modes:], compute_uv=False).min()
    if least < _LEAST_IN_COMMON:
        raise ValueError(
            f"speeds: the {modes} modes at {other.config.speed:g} rad/s are not those at {own.config.speed:g} rad/s (principal "
            f"cosine {least:.2g}); retain another number of modes or stay nearer"
        )
    return seen.T
