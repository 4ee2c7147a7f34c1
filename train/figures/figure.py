"""What figures consist of: curves in panels, with units and limits, however they are drawn."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from train.figures.palette import INK

Array = NDArray[np.float64]
Line = Literal["solid", "dashed", "dotted", "dashdot", "points", "bars"]
Limits = tuple[float | None, float | None]
"""Low and high; None where the data decide."""


@dataclass(frozen=True, slots=True)
class Marker:
    """The sign of points."""

    sign: str = "point"
    """One of plotly's names, or "point"."""
    size: float | None = None
    """Points of a PNG, pixels on a screen; None for the usual."""
    fill: Literal["full", "none", "white"] = "full"
    """White is the paper's colour."""
    every: tuple[int, int] = (0, 1)
    """First point that has it, and from there every n-th."""


@dataclass(frozen=True, slots=True)
class Look:
    """How a curve is drawn, besides its line."""

    colour: str = INK
    """ "#rrggbb"."""
    width: float | None = None
    """None for the usual."""
    opacity: float = 1.0
    marker: Marker | None = None
    above: bool = False
    """Whether it is drawn over all others."""


PLAIN = Look()


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """One curve of a panel. Curves of the same ``label`` look alike in all panels; ``line`` is solid, dotted, dashed, dashdot,
    points or bars, which are broad and end where they end.
    """

    x: Array
    y: Array
    label: str = ""
    """Empty for what explains itself: it is in no legend and tells nothing to a pointer."""
    line: str = "solid"
    look: Look = PLAIN
    listed: bool = True
    """Whether the legend shows it; of a label that is in several panels one is enough."""
    joined: Literal["straight", "smooth", "ends", "begins"] = "straight"
    """How points are joined; each value may be held over the interval that ends, or begins, at its point."""


@dataclass(frozen=True, slots=True)
class Note:
    """A word beside a point, below it and to its left."""

    x: float
    y: float
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """One pair of axes, with units in the axis labels."""

    title: str
    x_label: str
    y_label: str
    curves: Sequence[Curve]
    logarithmic: bool = False
    """y."""
    marked: Sequence[float] = ()
    """Values of x drawn as thin vertical lines."""
    whole: bool = False
    """y counts something: whole numbers at its ticks."""
    marked_line: str = "solid"
    x_limits: Limits = (None, None)
    y_limits: Limits = (None, None)
    x_linear_within: float | None = None
    """x is drawn in its logarithm, of either sign, beyond this."""
    notes: Sequence[Note] = ()
    y_names: Sequence[str] = ()
    """Of y = 1, 2, …, in place of numbers."""
    x_logarithmic: bool = False


def listed(panels: Iterable[Panel]) -> list[Curve]:
    """One curve for each entry of a legend, in the order of their first appearance."""
    found: dict[str, Curve] = {}
    for panel in panels:
        for curve in panel.curves:
            if curve.label and curve.listed:
                found.setdefault(curve.label, curve)
    return list(found.values())
