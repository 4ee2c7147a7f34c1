"""What patches of any size add to a blade wherever they lie: ``contributions`` at a few sizes, and polynomials in between.

What an actuator and a sensor opposite to each other do beyond what each does alone is taken at the middle size, in proportion to
the volumes of the sheets. Voltages are counted by the field that they make: a unit is a volt on the sheet that the blade has, and
on one twice as thick, driven across its thickness, two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from baselines.placement.model.chebyshev import ChebyshevSpan
from baselines.placement.model.contributions import BARE, BELOW, BOTH, TOP, Contributions, contributions, frame_of
from baselines.placement.sizing.sheets import SizeGrid, through_thickness, with_sheets
from beamenv.blade.config import BladeConfig
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

COUPLED = (TOP - 1, BELOW - 1, BOTH - 1)
"""Kinds of covered sections, in the order of the series."""


@dataclass(frozen=True, slots=True, eq=False)
class SizedContributions(ReadOnly):
    """Series of k coefficients for J sizes of the actuators' sheet, J of the sensors', and what the two have together."""

    middle: Contributions
    """At the middle of all sizes, whose coordinates are those of all."""
    grids: tuple[SizeGrid, SizeGrid]
    sizes: Array
    """(4,), m: width and thickness of the actuators and of the sensors, at the middle."""
    stiffness: Array
    """((2J + 1) k, T)."""
    tightening: Array
    """(k + (2J + 1) k, T): Ω² ∫S of the bare section, and what the others have beyond it."""
    mass: Array
    gyroscopic: Array
    """((2J + 1) k, T) each."""
    tension: tuple[Array, Array]
    """(J, k) each."""
    forces: Array
    """(J, k, N) per unit of drive, with nothing below."""
    charges: Array
    """(J, k, N), with nothing above."""

    @property
    def span(self) -> ChebyshevSpan:
        """Where patches may lie."""
        return self.middle.span


def sized_contributions(config: BladeConfig, grids: tuple[SizeGrid, SizeGrid]) -> SizedContributions:
    """Of a blade with one group of actuators and one of sensors; takes a second or two, and is kept."""
    patches = config.patches.placed("actuators", 1).placed("sensors", 1)
    return _sized(BladeConfig(beam=config.beam, patches=patches, model=config.model, speed=config.speed, modes=config.modes), grids)


@lru_cache(maxsize=4)
def _sized(config: BladeConfig, grids: tuple[SizeGrid, SizeGrid]) -> SizedContributions:
    sizes = np.array([0.5 * sum(span) for grid in grids for span in (grid.width, grid.thickness)])
    middle_config = with_sheets(config, sizes.tolist())
    frame = frame_of(middle_config)
    middle = contributions(middle_config, frame)
    above, below = (grid.nodes for grid in grids)
    every = max(len(above), len(below))
    pairs = [np.concatenate([above[min(j, len(above) - 1)], below[min(j, len(below) - 1)]]) for j in range(every)]
    at = [contributions(with_sheets(config, pair.tolist()), frame) for pair in pairs]
    counts = len(above), len(below)
    drive = [drive_of(config, pair[1]) for pair in pairs]
    return SizedContributions(
        middle=middle,
        grids=grids,
        sizes=sizes,
        stiffness=stacked([each.stiffness for each in at], middle.stiffness, middle.span.count, counts),
        tightening=tightenings(at, middle, counts),
        mass=stacked([each.mass for each in at], middle.mass, middle.span.count, counts),
        gyroscopic=stacked([each.gyroscopic for each in at], middle.gyroscopic, middle.span.count, counts),
        tension=(
            np.stack([each.tension[:, TOP] for each in at[: counts[0]]]),
            np.stack([each.tension[:, BELOW] for each in at[: counts[1]]]),
        ),
        forces=np.stack([share * each.actuator_force[0] for share, each in zip(drive, at, strict=True)][: counts[0]]),
        charges=np.stack([each.sensor_force[0] for each in at[: counts[1]]]),
    )


def drive_of(config: BladeConfig, thickness: float) -> float:
    """Volts per unit of drive on an actuator so thick."""
    patch = config.patches.only("actuators").patch
    return thickness / patch.thickness if through_thickness(patch) else 1.0


def stacked(at: list[Array], middle: Array, k: int, counts: tuple[int, int]) -> Array:
    """Series (3 k, T) of covered kinds at sizes, and at the middle, as ((J + J' + 1) k, T)."""
    top, below, both = (middle[kind * k : (kind + 1) * k] for kind in COUPLED)
    above = [each[:k] for each in at[: counts[0]]]
    return np.concatenate([*above, *(each[k : 2 * k] for each in at[: counts[1]]), both - top - below])


def tightenings(at: list[Contributions], middle: Contributions, counts: tuple[int, int]) -> Array:
    """Those of every kind beyond the bare one's, behind that."""
    k = middle.span.count

    def beyond_bare(series: Array) -> Array:
        bare = series[3 * k : 4 * k]
        return np.concatenate([series[(3 + kind) * k : (4 + kind) * k] - bare for kind in (TOP, BELOW, BOTH)])

    beyond = stacked([beyond_bare(each.stiffness) for each in at], beyond_bare(middle.stiffness), k, counts)
    return np.concatenate([middle.stiffness[(3 + BARE) * k : (4 + BARE) * k], beyond])
