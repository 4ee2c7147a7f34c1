"""Where the patches of several designs lie along the span."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from train.figures.figure import Curve, Look, Panel
from train.figures.palette import PALETTE

ACTUATORS, SENSORS = Look(PALETTE[0], width=2.6), Look(PALETTE[1], width=2.6)
ASIDE = 0.15
"""By how much actuators are drawn above and sensors below the number of their design."""


def patches_panel(points: Sequence[Any], span: float) -> Panel:
    """Patches of ``FrontPoint``s, from the lightest to the heaviest, on a span in m."""
    curves: list[Curve] = []
    for number, each in enumerate(points, start=1):
        for name, side, look, shift in (
            ("actuators", each.actuators, ACTUATORS, ASIDE),
            ("sensors", each.sensors, SENSORS, -ASIDE),
        ):
            curves.append(rows_of(side.patches, number + shift, name, look))
    title, across = "Their patches", "from the root (m)"
    return Panel(title, across, "design, lightest first", curves, whole=True, x_limits=(-0.02 * span, span))


def rows_of(patches: Sequence[Any], height: float, label: str, look: Look) -> Curve:
    """One line for all patches of a side, broken between them."""
    ends = np.array([[each.start, each.start + each.length, np.nan] for each in patches]).ravel()
    return Curve(ends, np.where(np.isnan(ends), np.nan, height), label, "solid", look)
