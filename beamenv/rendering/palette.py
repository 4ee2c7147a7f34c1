"""Colours, and the scales that turn values into them: matplotlib's diverging maps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INK, QUIET, PALE, FAINT, PAPER = "#1f2933", "#616e7c", "#9aa5b1", "#d5dbe1", "#ffffff"
LAG, FLAP = "#c2571a", "#2b6cb0"
VOLTAGE_SCALE, OUTPUT_SCALE = "RdBu_r", "PuOr_r"


def colour_table(name: str) -> Array:
    """(256, 3): the colours of a scale from −1 to 1, 0 … 255."""
    from matplotlib import colormaps

    return 255.0 * colormaps[name](np.linspace(0.0, 1.0, 256))[:, :3]


def colours_of(table: Array, values: Array) -> list[list[int]]:
    """RGB of values (k,) between −1 and 1; what lies beyond takes the colour of the end."""
    index = np.rint(127.5 * (1.0 + np.clip(values, -1.0, 1.0))).astype(int)
    chosen: list[list[int]] = np.rint(table[index]).astype(int).tolist()
    return chosen


def line_colours(count: int) -> list[str]:
    """Colours of as many voltages, root to tip, that are told apart by lightness too."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return [to_hex(colour) for colour in colormaps["plasma"](np.linspace(0.0, 0.75, count))]
