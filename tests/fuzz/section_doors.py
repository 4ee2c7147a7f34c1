"""Doors of sections of any shape, and of groups of patches."""

from collections.abc import Mapping

import numpy as np
from hypothesis import strategies as st

from beamenv.patches import PatchGroup, PatchMaterial
from beamenv.structure import (
    AirfoilSection,
    BoxSection,
    CSection,
    ISection,
    PolygonSection,
    StripSection,
    TubeSection,
    WallsSection,
    Web,
    ZSection,
)
from tests.fuzz.blade_doors import CORNERS, constructor
from tests.fuzz.meaning import NOTHING, NUMBER, NUMBERS, TEXT, Kind, either, instance, maybe


def _pairs(each):
    """Of a mapping, or pairs of a text and what ``each`` means."""

    def means(value):
        pairs = list(value.items()) if isinstance(value, Mapping) else value
        if not isinstance(pairs, (list, tuple)) or not all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs):
            return NOTHING
        read = tuple((TEXT.means(name), each(item)) for name, item in pairs)
        return NOTHING if any(NOTHING in pair for pair in read) or len(dict(read)) < len(read) else read

    return means


def _webs(value):
    if not isinstance(value, (list, tuple)) or not all(isinstance(each, Web) for each in value):
        return NOTHING
    return tuple(value)


def _line(value):
    rows = list(value) if isinstance(value, (list, tuple, np.ndarray)) and np.ndim(value) != 0 else NOTHING
    if rows is NOTHING:
        return NOTHING
    read = [NUMBERS.means(row) for row in rows]
    return tuple(read) if all(row is not NOTHING and len(row) == 2 for row in read) else NOTHING


WALL_NUMBERS = Kind(
    "thicknesses", _pairs(NUMBER.means), st.sampled_from([{}, {"top": 0.01}, {"web": -1}, {"no": 0.1}, [["top", 1]], "top"])
)
WEBS = Kind("webs", _webs, st.sampled_from([[], [Web(0.5)], (Web(0.2, "a"), Web(0.7, "b")), [0.5], "web", Web(0.5)]))
LINES = Kind("lines", _pairs(_line), st.sampled_from([{}, {"web": [[0, 0], [0, 1]]}, {"web": [[0, 0]]}, {"web": "line"}]))
CLOSED = {"webs": WEBS, "thicknesses": WALL_NUMBERS}
TOLD = ("corners", "edge_walls", "thickness", "thicknesses", "position", "coordinates", "profile")
"""What a sentence may be about when another field is wrong beside it."""
SIZES = {"width": 0.2, "depth": 0.06, "thickness": 0.004}
ANGLES = np.linspace(0.0, 2.0 * np.pi, 6, endpoint=False)

DOORS = [
    constructor(Web, {"position": 0.5}),
    constructor(BoxSection, SIZES, TOLD, **CLOSED),
    constructor(TubeSection, SIZES, TOLD, **CLOSED),
    constructor(AirfoilSection, {"chord": 0.3, "thickness": 0.0015}, TOLD, **CLOSED, coordinates=maybe(CORNERS)),
    constructor(
        PolygonSection,
        {
            "corners": tuple(zip(np.cos(ANGLES).tolist(), np.sin(ANGLES).tolist(), strict=True)),
            "edge_walls": ("a", "b", "c", "d", "e", "f"),
            "thickness": 0.01,
        },
        TOLD,
        **CLOSED,
        corners=CORNERS,
    ),
    constructor(StripSection, {"width": 0.03, "thickness": 0.002}, thicknesses=WALL_NUMBERS),
    *(constructor(cls, SIZES, thicknesses=WALL_NUMBERS) for cls in (ISection, CSection, ZSection)),
    constructor(
        WallsSection, {"lines": {"web": [[0.0, 0.0], [0.0, 0.1]]}, "thickness": 0.002}, lines=LINES, thicknesses=WALL_NUMBERS
    ),
    constructor(PatchGroup, {}, material=either(TEXT, instance(PatchMaterial))),
]
