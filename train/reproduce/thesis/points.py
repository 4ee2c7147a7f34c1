"""Numbers that the thesis prints, as points beside our curves: they look alike in all figures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import colour

PRINTED = "printed in the thesis"
ONE_AXIS = f"{PRINTED} (one axis only)"
"""Of a speed without its frequency, a peak without its time: it stands on the axis that it belongs to."""
SIGNS = ("circle", "square", "triangle-up")
"""Of the first labels of a figure: points of several series have those of their curves."""
COLOUR = colour(1)
SIZE = 5.5


def printed(x: ArrayLike, y: ArrayLike, of: str = "", sign: str = "diamond", line: str = "points") -> Curve:
    """Points (K,) that the thesis prints, ``of`` one of several series."""
    label = f"{of}, {PRINTED}" if of else PRINTED
    return Curve(np.asarray(x, dtype=float), np.asarray(y, dtype=float), label, line, look(sign))


def look(sign: str) -> Look:
    """Hollow, so that a curve beneath it shows, and over all curves."""
    return Look(COLOUR, marker=Marker(sign, SIZE, "white"), above=True)


def is_printed(curve: Curve) -> bool:
    """Whether a curve is the thesis' own numbers."""
    return PRINTED in curve.label


def on_x(panel: Panel, *values: float) -> Panel:
    """The panel with printed values of x, whose y is not printed, at its foot."""
    foot = min(float(np.min(curve.y)) for curve in panel.curves)
    return _with(panel, Curve(np.array(values), np.full(len(values), foot), ONE_AXIS, "points", look("triangle-up")))


def on_y(panel: Panel, *values: float) -> Panel:
    """The panel with printed values of y, whose x is not printed, at its left edge."""
    edge = min(float(np.min(curve.x)) for curve in panel.curves)
    return _with(panel, Curve(np.full(len(values), edge), np.array(values), ONE_AXIS, "points", look("triangle-right")))


def with_points(panel: Panel, x: ArrayLike, y: ArrayLike, sign: str = "diamond") -> Panel:
    """The panel with printed points (K,)."""
    return _with(panel, printed(x, y, sign=sign))


def _with(panel: Panel, curve: Curve) -> Panel:
    return replace(panel, curves=[*panel.curves, curve])
