"""One blade over a range of rotor speeds: a plant for each speed, and what a state at one speed means at another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import block_diag

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Number, Numbers, checked
from beamenv.configuration.read_only import Sealed
from beamenv.plant.plant import Plant
from beamenv.simulation.plants.coordinates import between

Array = NDArray[np.float64]

_LEAST_IN_COMMON = 0.5
"""Smallest principal cosine between the retained modes of two speeds at which they still span much the same motions."""

_SPARE = 6
"""Modes beyond the Nyquist frequency that a full plant may be given, where two change places within a family."""


@dataclass(frozen=True, slots=True, eq=False)
class SpeedFamily(Sealed):
    """Plants of one blade at k speeds, behind the same instruments, and the coordinates that they have in common."""

    speeds: Array
    """(k,), rad/s, ascending."""
    plants: tuple[Plant, ...]
    """One for each speed, in the coordinates of its own modes."""
    from_common: Array
    """(k, n, n): takes a state in the common coordinates, those of the configuration's own speed, to each plant's."""


def speed_family(config: BladeConfig, speeds: Sequence[float] | ArrayLike, *, full: bool = False) -> SpeedFamily:
    """The plants of ``config`` at ``speeds`` (rad/s), its sensors' range as fitted at its own speed.

    With modes ΨᵀMΨ = I at one speed and Ψ₀ at the configuration's own, a motion Ψ₀ η₀ has the coordinates η = ΨᵀMΨ₀ η₀; as states
    are [ωη; η̇], signs and order of the modes do not matter. With ``full`` the plants are all that is known of the blade, as
    ``Design.full_plant`` is, with the same number of modes at every speed, and what the electronics hold is common. Raises
    ValueError for speeds that do not ascend, lie beyond the critical speed, or are so far away that the retained modes are others.
    """
    given = (speeds,) if np.ndim(speeds) == 0 else speeds
    grid = np.array(checked("speeds", given, Numbers(Number(ge=0.0, unit="rad/s"), least=1)), dtype=np.float64)
    if np.any(np.diff(grid) <= 0.0):
        raise ValueError(f"speeds = {speeds!r} must be one or more numbers in rad/s, each greater than the one before.")
    own = Blade(config).with_fixed_range()
    if full:
        known = _known_at_all(own, grid)
        own = own.changed(replace(own.config, modes=known, truth_modes=known))
    plants, views = zip(*(_at(own, speed, full) for speed in grid), strict=True)
    return SpeedFamily(grid, plants, np.stack(views))


def _at(own: Blade, speed: float, full: bool) -> tuple[Plant, Array]:
    """The plant at one speed, and what takes states in the common coordinates to it."""
    there = own.changed(replace(own.config, speed=float(speed)))
    plant = there.truth if full else there.plant
    return plant, block_diag(_from_common(own, there), np.eye(plant.electronic_states))


def _known_at_all(own: Blade, grid: Array) -> int:
    """How many modes: those of the full plant and the fewest beyond, if more are known, that move alike at all speeds."""
    known, size = len(own.true_modal.natural_frequencies), own.beam.space.size
    if own.config.truth_modes is not None or own.config.model == "thesis":
        return known
    wide = own.changed(replace(own.config, modes=min(known + _SPARE, size)))
    many = wide.config.modes
    seen = [between(wide.modal, wide.changed(replace(wide.config, speed=float(speed))))[many:, many:] for speed in grid]
    cosines = [min(np.linalg.svd(each[:k, :k], compute_uv=False).min() for each in seen) for k in range(known, many + 1)]
    return known + next((k for k, cosine in enumerate(cosines) if cosine >= _LEAST_IN_COMMON), 0)


def _from_common(own: Blade, other: Blade) -> Array:
    seen = between(own.modal, other)  # the blade is the same, and so are its trial functions
    modes = own.config.modes
    least = np.linalg.svd(seen[modes:, modes:], compute_uv=False).min()
    if least < _LEAST_IN_COMMON:
        raise ValueError(
            f"speeds: the {modes} modes at {other.config.speed:g} rad/s are not those at {own.config.speed:g} rad/s (principal "
            f"cosine {least:.2g}); retain another number of modes or stay nearer."
        )
    return seen.T
