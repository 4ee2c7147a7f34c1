"""Numbers in another unit than is meant: lengths in millimetres, moduli in GPa, densities in g/cm³, angles in radians.

A blade of 300 m that was to be one of 300 mm can be computed, and vibrates at 0.00 Hz. So what no blade has is refused, with the
unit that may have been meant. From a strip of 2 cm to a wind turbine's blade of 150 m all that is built passes.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from beamenv.configuration import Refused
from beamenv.configuration.sentence import in_millimetres
from beamenv.structure.sizes import THICKEST, WIDEST
from beamenv.structure.walls.graded import FunctionallyGraded
from beamenv.structure.walls.materials import MODULI, Lamina

SLENDEREST = 2000.0
"""Span over the section's larger size: wind turbines' blades have 20, a wire of 1 mm and 1 m has 1000."""

SOFTEST = 1e6
"""Pa: that of soft rubber, and above any material's in GPa; any metal's in MPa is below."""

LIGHTEST = 25.0
"""kg/m³: below the lightest foams of sandwiches, which have 30; in g/cm³ all densities would be below it."""

LEAST = {**dict.fromkeys(MODULI, SOFTEST), "density": LIGHTEST}
"""Of a lamina, which as such may be softer and lighter."""

RADIAN_STEP, RADIAN_DIGITS = np.pi / 36.0, 5e-5
"""Angles of whole multiples of 5°, printed in radians to four digits: so is hardly any angle in degrees."""


def check_units(beam: Any) -> None:
    """``ValueError`` of one sentence, with the unit that may have been meant, for a number of a ``BeamConfig`` that no blade has.

    ``UserWarning`` where angles look like radians, which they may all the same not be.
    """
    for path, value, most in _sizes(beam):
        if value > most:
            raise Refused(path, value, f"at most {most:g} (m)", in_millimetres(value, most))
    _check_slender(beam)
    for path, lamina in laminae(beam.material):
        _check_density(f"beam.{path}", lamina)
    _warn_of_radians(beam)


def check_moduli(material: str | Lamina | FunctionallyGraded) -> None:
    """``ValueError`` for a modulus that is below any solid's."""
    for path, lamina in laminae(material):
        for name in MODULI:
            value = getattr(lamina, name)
            if value < SOFTEST:
                unit = "GPa" if value < 2e3 else "MPa"
                raise Refused(f"{path}.{name}", value, f"at least {SOFTEST:g} (Pa)", f" (did you give {unit}?)")


def laminae(material: str | Lamina | FunctionallyGraded) -> list[tuple[str, Lamina]]:
    """Paths of the laminae that are given, and themselves."""
    if isinstance(material, FunctionallyGraded):
        parts = [("material.inner", material.inner), ("material.outer", material.outer)]
    else:
        parts = [("material", material)]
    return [(path, each) for path, each in parts if isinstance(each, Lamina)]


def _sizes(beam: Any) -> Iterator[tuple[str, float, float]]:
    """Paths of a section's lengths, themselves and what they are at most, m."""
    home, section = _section(beam)
    for name in ("width", "depth", "chord"):
        yield f"{home}.{name}", getattr(section, name, 0.0), WIDEST
    for name in ("corners", "lines"):
        if hasattr(section, name):
            yield f"{home}.{name}", _size(beam), WIDEST
    yield f"{home}.thickness", getattr(section, "thickness", 0.0), THICKEST
    for wall, thickness in getattr(section, "thicknesses", ()):
        yield f"{home}.thicknesses.{wall}", thickness, THICKEST


def _section(beam: Any) -> tuple[str, Any]:
    return ("beam", beam) if beam.section is None else ("beam.section", beam.section)


def _size(beam: Any) -> float:
    """m: the larger of what the section extends over along x and y."""
    if beam.section is None:
        return max(beam.width, beam.depth)
    return float(np.ptp(beam.section.vertices, axis=0).max())


def _check_slender(beam: Any) -> None:
    """``ValueError`` where span and section cannot have been given in the same unit."""
    size, (home, section) = _size(beam), _section(beam)
    name = next((each for each in ("chord", "width", "corners", "lines") if hasattr(section, each)), "section")
    if beam.length > SLENDEREST * size:
        most = SLENDEREST * size
        allowed = f"at most {SLENDEREST:g} times the section's size, {most:.4g} (m), by {home}.{name}"
        raise Refused("beam.length", beam.length, allowed, in_millimetres(beam.length, most))
    if size > beam.length:
        raise Refused(f"{home}.{name}", size, f"at most the beam's length, {beam.length:g} (m)", in_millimetres(size, beam.length))


def _check_density(path: str, lamina: Lamina) -> None:
    if lamina.density < LIGHTEST:
        meant = " (did you give g/cm³?)" if lamina.density > 0.5 else ""
        raise Refused(f"{path}.density", lamina.density, f"at least {LIGHTEST:g} (kg/m³)", meant)


def _warn_of_radians(beam: Any) -> None:
    given = {f"ply_angles_deg.{wall}": angles for wall, angles in beam.ply_angles_deg}
    given |= {"pretwist_deg": (beam.pretwist_deg,), "presetting_deg": (beam.presetting_deg,)}
    for name, angles in given.items():
        if in_radians(angles):
            degrees = ", ".join(f"{np.degrees(each):.4g}" for each in dict.fromkeys(angles))
            told = f"blade.beam.{name} is taken for {', '.join(f'{each:g}' for each in dict.fromkeys(angles))} degrees"
            warnings.warn(f"{told}; if these are radians, give {degrees}.", stacklevel=2)


def in_radians(angles: Sequence[float]) -> bool:
    """Whether all angles that are not zero are whole multiples of 5° in radians, to four digits, and none beyond half a turn."""
    some = np.abs([each for each in angles if each])
    steps = np.round(some / RADIAN_STEP)
    near = np.abs(some - RADIAN_STEP * steps) <= RADIAN_DIGITS
    within = (steps > 0) & (some <= np.pi + RADIAN_DIGITS)
    return bool(len(some) and (near & within).all())
