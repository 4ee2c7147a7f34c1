"""Stiffness quantities of the thesis' appendices: a22, a33 and ã2, from the section's energy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import RotatingBeam
from beamenv.structure.walls.wall_kinematics import GX, TX, TY

Array = NDArray[np.float64]


def bending_stiffness(beam: RotatingBeam, station: float = 0.5) -> tuple[float, float]:
    """a22 (of θy', lag) and a33 (of θx', flap) in N m² at z = ``station`` · L, shear strains held at zero as in the thesis."""
    section = section_stiffness(beam, station)
    return float(section[TY, TY]), float(section[TX, TX])


def shear_bending_stiffness(beam: RotatingBeam, station: float = 0.5) -> float:
    """ã2 in N m: what the higher-order theory adds to the coupling of θx' with γx."""
    first_order = replace(beam, shear="first_order")
    return float((section_stiffness(beam, station) - section_stiffness(first_order, station))[TX, GX])


def section_stiffness(beam: RotatingBeam, station: float) -> Array:
    """(9, 9): the section's stiffness for the generalised strains at z = ``station`` · L."""
    return beam.walls_at(np.array([station * beam.length])).stiffness()[0]
