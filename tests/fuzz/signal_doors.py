"""Doors of sensors and of loads of one's own."""

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st

from beamenv.blade.load_shapes import LoadShape
from beamenv.scenarios.own_loads import Load
from beamenv.sensors.kinds import SENSORS
from tests.fuzz.blade_doors import constructor
from tests.fuzz.meaning import NOTHING, NUMBERS, Kind, either, maybe

HEEDED = ("position", "profile", "point", "onset", "duration", "frequency", "phase_deg", "cutoff", "order", "damping")
TOLD = ("direction", "span", "series", "rate", "function", "spectrum", *HEEDED)
"""What a sentence may be about when another field is wrong beside it."""


def _rows(value):
    if not isinstance(value, (list, tuple, np.ndarray)) or np.ndim(value) == 0:
        return NOTHING
    read = [NUMBERS.means(row) for row in value]
    return tuple(read) if all(row is not NOTHING and len(row) == 2 for row in read) else NOTHING


TABLES = [[0, 1], [10, 1]], [[0, 1]], [[5, 1], [1, 1]], [[0, -1], [1, 1]], "flat"
SPECTRUM = Kind("spectrum", _rows, st.sampled_from(TABLES))
FILE = Kind("file", lambda value: value if isinstance(value, str) else NOTHING, st.sampled_from(["gust.csv", "gust.txt", ""]))
FUNCTION = Kind(
    "function", lambda value: value if isinstance(value, Callable) else NOTHING, st.sampled_from([np.sin, abs, 1.0, "f"])
)
LOAD = {"series": maybe(either(NUMBERS, FILE)), "spectrum": maybe(SPECTRUM), "function": maybe(FUNCTION)}

DOORS = [
    *(constructor(cls, {"position": 0.1} if kind == "strain-gauge" else {}, TOLD) for kind, cls in SENSORS.items()),
    constructor(LoadShape, {}, TOLD),
    constructor(Load, {}, TOLD, **LOAD),
    constructor(Load, {"course": "noise"}, TOLD, **LOAD),
    constructor(Load, {"course": "series", "series": (0.0, 1.0), "rate": 10.0}, TOLD, **LOAD),
]
