"""Airfoils: NACA's of four digits by their formula, others by their coordinates."""

from __future__ import annotations

import re
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Choice, Items, Number, Points, Refused, Text, configuration
from beamenv.structure.section.closed_sections import MOST_CORNERS, ClosedSection
from beamenv.structure.section.section import Metres
from beamenv.structure.section.wall_thicknesses import Thicknesses
from beamenv.structure.section.webs import Web
from beamenv.structure.walls.contour import meets_itself

Array = NDArray[np.float64]

PIECES = 30
"""Of the upper and of the lower side of a NACA profile; shorter towards the leading edge."""

NACA = re.compile(r"(?:NACA[ -]?)?(\d{4})", re.IGNORECASE)

BEYOND = 0.05
"""Over the chord: how far a profile may reach ahead of its leading edge at 0, as cambered ones do, and behind its trailing edge."""

LEAST_TAIL = 0.5
"""Of the chord: where the tail closes the contour at the earliest."""

OVER_CHORD = "with x from 0 at the leading edge to 1 at the trailing edge"

THICKNESS = (0.2969, -0.1260, -0.3516, 0.2843, -0.1015)
"""Of √x, x, x², x³ and x⁴ in the half thickness over five times that of the profile (Abbott and von Doenhoff 1959, Eq. 6.2)."""


@configuration("section")
class AirfoilSection(ClosedSection):
    """An airfoil whose mid-line is a profile of some ``chord`` (m), x towards the trailing edge, closed by a straight tail.

    The profile is a NACA one of four digits, by its name, or ``coordinates`` over the chord: from the trailing edge over the top to
    the leading edge at (0, 0) and back below. Its origin is the quarter chord. Its walls are tail, top and bottom. Raises
    ``ValueError`` for another name, coordinates that do not go round so or cross themselves, and walls too thick.
    """

    drawn_by = "coordinates"

    chord: Metres
    thickness: Metres
    profile: Annotated[str, Text()] = "NACA 0012"
    """Its name; of coordinates, any."""
    coordinates: Annotated[tuple[tuple[float, float], ...] | None, Points(least=5, most=MOST_CORNERS)] = None
    trailing_edge: Annotated[float, Number(ge=LEAST_TAIL, le=1.0)] = 0.96
    """Of the chord: where the tail closes the contour. Nearer to a sharp trailing edge the walls would fill it."""
    webs: Annotated[tuple[Web, ...], Items(Web)] = ()
    thicknesses: Thicknesses = ()
    """m, of walls that are not as thick as the others."""
    shape: Annotated[str, Choice(("airfoil",))] = "airfoil"

    def __post_init__(self) -> None:
        if self.coordinates is None and not NACA.fullmatch(self.profile.strip()):
            raise Refused("profile", self.profile, "NACA and four digits, say 'NACA 0012', or have coordinates")
        if self.coordinates is None and self._digits[2] == 0.0:
            raise Refused("profile", self.profile, "one of some thickness, its last two digits")
        self._check_shares()
        sides = self._sides()
        if min(map(len, sides)) < 3 or meets_itself(np.concatenate([sides[0], sides[1][1:]])):
            allowed = "points from the trailing edge over the top to the leading edge and back below, that meet nowhere"
            raise Refused("coordinates", self.coordinates, allowed)
        self.check_walls()

    def _check_shares(self) -> None:
        """``ValueError`` for coordinates that are not over the chord: in percent, say, or in metres."""
        for k, (x, y) in enumerate(self.coordinates or ()):
            if not (-BEYOND <= x <= 1.0 + BEYOND and -1.0 <= y <= 1.0):
                raise Refused(f"coordinates[{k}]", [x, y], f"a point over the chord, {OVER_CHORD}: divide percentages by 100")
        farthest = max((x for x, _ in self.coordinates or ()), default=1.0)
        if farthest < LEAST_TAIL:
            allowed = f"points over the chord, {OVER_CHORD}, and not in metres: the last lie at x = {farthest:g}"
            raise Refused("coordinates", self.coordinates, allowed)

    @property
    def vertices(self) -> Array:
        """(K, 2), from the tail's lower end."""
        top, bottom = self._sides()
        around = np.concatenate([bottom[-1:], top, bottom[1:-1]])
        return self.chord * (around - np.array([0.25, 0.0]))

    @property
    def walls(self) -> tuple[str, ...]:
        """Of each piece: tail, then top and bottom."""
        top, bottom = self._sides()
        return ("tail", *("top",) * (len(top) - 1), *("bottom",) * (len(bottom) - 1))

    @property
    def thickness_limit(self) -> float:
        """The tail's length, m."""
        top, bottom = self._sides()
        return float(self.chord * np.linalg.norm(top[0] - bottom[-1]))

    @property
    def _digits(self) -> tuple[float, float, float]:
        """Camber, its place, and thickness, over the chord."""
        found = NACA.fullmatch(self.profile.strip())
        digits = found.group(1) if found else "0012"
        return int(digits[0]) / 100.0, int(digits[1]) / 10.0, int(digits[2:]) / 100.0

    def _sides(self) -> tuple[Array, Array]:
        """Top from the tail to the leading edge, bottom from there to the tail: (k, 2) each, over the chord."""
        if self.coordinates is None:
            return naca_sides(*self._digits, self.trailing_edge)
        points = np.array(self.coordinates)
        nose = int(points[:, 0].argmin())
        top, bottom = points[: nose + 1][::-1], points[nose:]
        return _cut_off(top, self.trailing_edge)[::-1], _cut_off(bottom, self.trailing_edge)


def naca_sides(camber: float, place: float, thickness: float, trailing_edge: float) -> tuple[Array, Array]:
    """Top and bottom of a NACA profile of four digits (Abbott and von Doenhoff 1959, Eqs. 6.1–6.4)."""
    x = trailing_edge * (1.0 - np.cos(np.linspace(0.0, 0.5 * np.pi, PIECES + 1)))
    powers = np.stack([np.sqrt(x), x, x**2, x**3, x**4], axis=-1)
    half = 5.0 * thickness * powers @ np.array(THICKNESS)
    line, slope = np.zeros_like(x), np.zeros_like(x)
    if camber:
        place = max(place, 1e-9)
        ahead = x < place
        line = np.where(ahead, camber / place**2 * (2.0 * place * x - x**2), 0.0)
        slope = np.where(ahead, 2.0 * camber / place**2 * (place - x), 0.0)
        behind = camber / (1.0 - place) ** 2
        line = np.where(ahead, line, behind * (1.0 - 2.0 * place + 2.0 * place * x - x**2))
        slope = np.where(ahead, slope, 2.0 * behind * (place - x))
    turned = np.arctan(slope)
    across = half[:, None] * np.stack([-np.sin(turned), np.cos(turned)], axis=-1)
    middle = np.stack([x, line], axis=-1)
    return (middle + across)[::-1], middle - across


def _cut_off(side: Array, at: float) -> Array:
    """A side from the leading edge on (k, 2), to where x is ``at``."""
    beyond = np.flatnonzero(side[:, 0] >= at)
    if not len(beyond):
        return side
    k = int(beyond[0])
    while k > 2 and at - side[k - 1, 0] < 0.5 * (side[k - 1, 0] - side[k - 2, 0]):
        side, k = np.delete(side, k - 1, axis=0), k - 1  # a piece much shorter than its neighbour has no room for its wall
    share = (at - side[k - 1, 0]) / (side[k, 0] - side[k - 1, 0])
    return np.concatenate([side[:k], (side[k - 1] + share * (side[k] - side[k - 1]))[None]])
