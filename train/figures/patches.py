"""Where the patches of several designs lie along the span."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from train.figures.figure import Curve, Look, Panel
from train.figures.palette import PALETTE

ACTUATORS, SENSORS = Look(PALETTE[0]), Look(PALETTE[1])
ASIDE = 0.15
"""By how much actuators are drawn above and sensors below the number of their design."""
SHORTER = 0.0015
"""Of the span, at either end of a patch: neighbours that touch are told apart."""


def patches_panel(points: Sequence[Any], span: float) -> Panel:
    """Patches of ``FrontPoint``s, from the lightest to the heaviest, on a span in m."""
    curves = [
        curve
        for number, each in enumerate(points, start=1)
        for curve in rows_of(each.actuators.patches, each.sensors.patches, number, span)
    ]
    title, across = "patches of the designs", "from the root, m"
    return Panel(title, across, "design, lightest first", curves, whole=True, x_limits=(-0.02 * span, span))


def rows_of(actuators: Sequence[Any], sensors: Sequence[Any], number: int, span: float) -> list[Curve]:
    """A row of actuators and one of sensors, about the number of their design."""
    return [
        Curve(*_bars(patches, number + shift, SHORTER * span), name, "bars", look)
        for name, patches, look, shift in (("actuators", actuators, ACTUATORS, ASIDE), ("sensors", sensors, SENSORS, -ASIDE))
    ]


def _bars(patches: Sequence[Any], height: float, shorter: float) -> tuple[Any, Any]:
    """The ends of patches, one after the other, and their height, broken between them."""
    ends = np.array([[each.start + shorter, each.start + each.length - shorter, np.nan] for each in patches]).ravel()
    return ends, np.where(np.isnan(ends), np.nan, height)
