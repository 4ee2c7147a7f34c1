"""Mode shapes along the span, how straight they are, and how modes of two speeds or two models compare."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beamenv.structure import Modes, RotatingBeam

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

DISPLACEMENT = {"lag": "u", "flap": "v", "extension": "s", "twist": "phi"}
"""The displacement each family of motion is drawn by."""

STATIONS = np.linspace(0.0, 1.0, 81)
"""z/L."""


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """One normalised mode shape."""

    frequency: float
    """rad/s."""
    values: Array
    """Displacement at ``STATIONS``, at most one, positive at the tip."""

    @property
    def bow(self) -> float:
        """Mean distance from the straight line between root and tip: the straighter the beam, the smaller."""
        return float(np.trapezoid(np.abs(self.values - STATIONS * self.values[-1]), STATIONS))


def family_shapes(
    beam: RotatingBeam,
    speed: float,
    family: str,
    count: int = 3,
    gyroscopic: bool = True,
    motions: tuple[str, ...] | None = None,
) -> list[Shape]:
    """The first ``count`` shapes of a family (lag, flap, extension or twist), at a speed in rad/s.

    A complex shape is turned in phase so that its tip is real. Raises ``ValueError`` when fewer modes of the family are among the
    lower half of all.
    """
    modes = beam.modes(speed, len(beam.space.columns(motions)) // 2, motions, gyroscopic)
    chosen = [k for k, name in enumerate(modes.families) if name == family][:count]
    if len(chosen) < count:
        raise ValueError(f"count = {count!r} must not exceed {len(chosen)}, the {family} modes found.")
    rows = beam.displacements(STATIONS * beam.length)[DISPLACEMENT[family]]
    displaced = rows @ modes.mode_shapes[:, chosen]
    return [Shape(float(modes.natural_frequencies[k]), normalised(displaced[:, i])) for i, k in enumerate(chosen)]


def normalised(displacement: Array | ComplexArray) -> Array:
    """A shape in phase with its tip, divided by its largest displacement: real, positive at the tip.

    (Not by the tip's own: under pretwist the tip of a mode may stand still.)
    """
    in_phase = (displacement * np.conj(displacement[-1])).real
    return np.asarray(in_phase / np.abs(in_phase).max())


def assurance(mass: Array, first: ComplexArray | Array, second: ComplexArray | Array) -> Array:
    """Modal assurance criterion weighted by mass, (columns of ``first``, columns of ``second``): 1 for the same mode."""
    cross = np.abs(first.conj().T @ mass @ second) ** 2
    own = [np.einsum("ij,ij->j", shapes.conj(), mass @ shapes).real for shapes in (first, second)]
    return np.asarray(cross / np.outer(*own))


def state_assurance(beam: RotatingBeam, one: Modes, other: Modes) -> Array:
    """The modal assurance criterion between the modes of one beam at two speeds."""
    return assurance(beam.matrices.mass, one.mode_shapes, other.mode_shapes)
