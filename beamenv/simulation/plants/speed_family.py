"""One blade over a range of rotor speeds: a plant for each speed, and what a state at one speed means at another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.blade.build import build_beam, build_plant
from beamenv.blade.config import BladeConfig
from beamenv.plant.plant import Plant
from beamenv.simulation.plants.coordinates import seen_from

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
    grid = np.atleast_1d(np.asarray(speeds, dtype=np.float64))
    if grid.ndim != 1 or not grid.size or not np.isfinite(grid).all() or np.any(np.diff(grid) <= 0.0):
        raise ValueError(f"speeds = {speeds!r} must be one or more numbers in rad/s, each greater than the one before")
    full_scale = float(build_plant(config).sensor_full_scale[0])
    family = [replace(config, speed=float(speed), sensor_full_scale=full_scale) for speed in grid]
    return SpeedFamily(grid, tuple(map(build_plant, family)), np.stack([_from_common(config, each) for each in family]))


def _from_common(config: BladeConfig, other: BladeConfig) -> Array:
    seen = seen_from(config, build_beam(config), other)
    assert seen is not None  # the blade is the same
    least = np.linalg.svd(seen[config.modes :, config.modes :], compute_uv=False).min()
    if least < _LEAST_IN_COMMON:
        raise ValueError(
            f"speeds: the {config.modes} modes at {other.speed:g} rad/s are not those at {config.speed:g} rad/s (principal cosine "
            f"{least:.2g}); retain another number of modes or stay nearer"
        )
    return seen.T
