"""Colours, and the scales that turn values into them: matplotlib's diverging maps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Shades = tuple[tuple[float, float, float], tuple[float, float, float]]


@dataclass(frozen=True, slots=True)
class Theme:
    """The colours of a page, all but those that stand for values."""

    paper: str
    ink: str
    quiet: str
    """What explains."""
    pale: str
    """The blade at rest."""
    faint: str
    """Grids."""
    lag: str
    flap: str
    load: str
    outline: str
    """Of patches."""
    body: Shades
    """In the shade and in the light."""
    hub: Shades
    lines: tuple[float, float]
    """Ends of the part of matplotlib's scale "plasma" that lines are told apart by."""


LIGHT = Theme(
    paper="#ffffff",
    ink="#1f2933",
    quiet="#616e7c",
    pale="#9aa5b1",
    faint="#d5dbe1",
    lag="#c2571a",
    flap="#2b6cb0",
    load="#b3261e",
    outline="#1f2933",
    body=((92.0, 104.0, 118.0), (205.0, 212.0, 220.0)),
    hub=((40.0, 49.0, 59.0), (92.0, 104.0, 117.0)),
    lines=(0.0, 0.75),
)
DARK = Theme(
    paper="#0d1117",
    ink="#e6eaef",
    quiet="#98a4b1",
    pale="#6b7684",
    faint="#2a323c",
    lag="#f0883e",
    flap="#6cb0f5",
    load="#ff8a80",
    outline="#c3ccd6",
    body=((74.0, 85.0, 98.0), (168.0, 178.0, 190.0)),
    hub=((60.0, 70.0, 82.0), (112.0, 124.0, 138.0)),
    lines=(0.35, 1.0),
)
VOLTAGE_SCALE, OUTPUT_SCALE = "RdBu_r", "PuOr_r"
INK = LIGHT.ink
"""Of letters and outlines on what has a colour of a scale, in every theme."""


def colour_table(name: str) -> Array:
    """(256, 3): the colours of a scale from −1 to 1, 0 … 255."""
    from matplotlib import colormaps

    return 255.0 * colormaps[name](np.linspace(0.0, 1.0, 256))[:, :3]


def colours_of(table: Array, values: Array) -> list[list[int]]:
    """RGB of values (k,) between −1 and 1; what lies beyond takes the colour of the end."""
    index = np.rint(127.5 * (1.0 + np.clip(values, -1.0, 1.0))).astype(int)
    chosen: list[list[int]] = np.rint(table[index]).astype(int).tolist()
    return chosen


def line_colours(count: int, theme: Theme = LIGHT) -> list[str]:
    """Colours of as many voltages, root to tip, that are told apart by lightness too."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return [to_hex(colour) for colour in colormaps["plasma"](np.linspace(*theme.lines, count))]
