"""Loci that come close and turn away from each other, exchanging their modes (Figures 3.8 to 3.10)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import RotatingBeam
from beamenv.structure.sweep import frequency_sweep
from train.reproduce.thesis.shapes import state_assurance

Array = NDArray[np.float64]

LAG_EXTENSION = ("lag", "extension")


@dataclass(frozen=True, slots=True)
class Veering:
    """Where the gap between two neighbouring loci is least."""

    lower: int
    """The lower locus, counted from 0; the upper one is the next."""
    speed: float
    """rad/s."""
    frequency: float
    """rad/s, midway between the loci."""
    gap: float
    """rad/s."""


def locate_veering(beam: RotatingBeam, lower: int, speeds: Array, motions: tuple[str, ...] = LAG_EXTENSION) -> Veering:
    """The least gap between loci ``lower`` and ``lower`` + 1 within the range of ``speeds`` (rad/s), refined by a parabola.

    Raises ``ValueError`` when the gap is least at an end of the range.
    """
    loci = frequency_sweep(beam, speeds, lower + 2, motions)
    gaps = loci[:, lower + 1] - loci[:, lower]
    at = int(np.argmin(gaps))
    if at in (0, len(speeds) - 1):
        raise ValueError(
            f"speeds = {speeds[0]:g} … {speeds[-1]:g} rad/s must contain the least gap of loci {lower} and {lower + 1}."
        )
    near = slice(at - 1, at + 2)
    curvature, slope, level = np.polyfit(speeds[near] - speeds[at], gaps[near], 2)
    offset = -slope / (2.0 * curvature)
    speed = float(speeds[at] + offset)
    middle = float(loci[near, lower : lower + 2].mean(axis=1)[1])
    return Veering(lower, speed, middle, float(level + 0.5 * slope * offset))


def exchange(beam: RotatingBeam, veering: Veering, distance: float, motions: tuple[str, ...] = LAG_EXTENSION) -> Array:
    """(2, 2): the modal assurance criterion between both loci ``distance`` rad/s before and after a veering.

    Exchanged modes have ones off the diagonal; loci that merely cross each other on the plot would keep them on it.
    """
    pair = slice(veering.lower, veering.lower + 2)
    count = veering.lower + 2
    before = beam.modes(veering.speed - distance, count, motions)
    after = beam.modes(veering.speed + distance, count, motions)
    return state_assurance(beam, before, after)[pair, pair]
