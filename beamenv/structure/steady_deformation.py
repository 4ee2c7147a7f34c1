"""What steady rotation does to a blade: how far its tip moves out and unwinds, and how much its outer face is strained."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.beam import RotatingBeam

Array = NDArray[np.float64]

INTERVALS = 40
"""Of the span, at whose ends strains are looked at: the largest strain is within 0.5 % of that of five times as many."""

AT_CLAMP = 1e-6
"""Of the span: where the clamp's strains are taken."""


@dataclass(frozen=True, slots=True)
class SteadyDeformation:
    """Of a blade that turns at one speed, against the blade at rest; nothing vibrates. All zero in the thesis' model."""

    stretch: float
    """m: how far the tip has moved along the span."""
    untwist: float
    """Degrees: turn of the tip section against the pretwist; against a positive one where the blade has none."""
    strain: float
    """Spanwise, of the outer face: the one of largest magnitude, with its sign."""
    strain_at: float
    """m from the root: where it is."""


STILL = SteadyDeformation(0.0, 0.0, 0.0, 0.0)


def steady_deformation(beam: RotatingBeam, speed: float) -> SteadyDeformation:
    """That of a blade at a speed in rad/s below the critical one."""
    if beam.model == "thesis":
        return STILL
    return deformed(beam, speed, face_strain(beam, speed))


def face_strain(beam: RotatingBeam, speed: float) -> Array:
    """(INTERVALS + 1, points): spanwise strain in the steady state at the outer face, at equal distances from clamp to tip."""
    return beam.steady_strain(beam.length * _shares(), speed)


def deformed(beam: RotatingBeam, speed: float, strain: Array) -> SteadyDeformation:
    """As ``steady_deformation``, with the strains of ``face_strain`` at hand."""
    steady = beam.at(speed).steady
    assert steady is not None
    tip = beam.displacements(np.array([beam.length]))
    against = -1.0 if beam.pretwist_deg >= 0.0 else 1.0
    station, point = np.unravel_index(np.abs(strain).argmax(), strain.shape)
    return SteadyDeformation(
        stretch=float((tip["s"] @ steady.coefficients)[0]),
        untwist=against * float(np.degrees(tip["phi"] @ steady.coefficients)[0]),
        strain=float(strain[station, point]),
        strain_at=beam.length * float(station) / INTERVALS,
    )


def _shares() -> Array:
    return np.maximum(np.linspace(0.0, 1.0, INTERVALS + 1), AT_CLAMP)
