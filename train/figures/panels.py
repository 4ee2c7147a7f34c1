"""Panels that are shown in more than one place: voltages, closed-loop poles, learning curves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import LINES, NEUTRAL, SIGNS, colour

Array = NDArray[np.float64]

LINEAR_POLES = 10.0
"""rad/s: real parts below this are drawn to scale, larger ones in the logarithm."""


def actuator(index: int) -> tuple[Look, str]:
    """Look and line of an actuator's voltage, or of a patch, told apart in greyscale too."""
    return Look(colour(index + 2)), LINES[index % len(LINES)]


def voltage_curves(time: Array, volts: Array) -> list[Curve]:
    """One for each actuator: ``volts`` (K, m) that are held over the interval that ends at each of the times (K,)."""
    looks = [actuator(index) for index in range(volts.shape[1])]
    return [
        Curve(time, each, f"actuator {index}", line, look, joined="ends")
        for index, (each, (look, line)) in enumerate(zip(volts.T, looks, strict=True), start=1)
    ]


def pole_panel(poles: Mapping[str, NDArray[Any]], highest: float | None = None) -> Panel:
    """Poles (rad/s) of each loop in the upper half plane, up to ``highest``; the first loop is grey: without control."""
    curves = []
    for index, (name, values) in enumerate(poles.items()):
        shown = values[values.imag >= -1e-9]
        marker = Marker(SIGNS[index % len(SIGNS)], fill="none")
        look = Look(NEUTRAL if index == 0 else colour(index - 1), marker=marker)
        curves.append(Curve(shown.real, shown.imag, name, "points", look))
    return Panel(
        "",
        "real part, rad/s",
        "imaginary part, rad/s",
        curves,
        marked=(0.0,),
        y_limits=(0.0, highest),
        x_linear_within=LINEAR_POLES,
    )


@dataclass(frozen=True, slots=True, eq=False)
class LearningCurves:
    """How agents learned, and what they are measured against."""

    curves: Mapping[str, Array]
    """(k, 3) each: training time in s, steps, cost relative to no control on validation seeds, or as its name says."""
    levels: Mapping[str, float] = field(default_factory=dict)
    """Relative cost of controllers that do not learn: LQG's line."""


def learning_panel(learned: LearningCurves) -> Panel:
    """Cost of each agent over its training time, and a line for each controller that does not learn."""
    curves = []
    for index, (name, curve) in enumerate(learned.curves.items()):
        steps = f" ({curve[-1, 1] / 1e6:.1f} million steps)" if len(curve) else ""
        curves.append(Curve(curve[:, 0], curve[:, 2], name + steps, LINES[index % len(LINES)], Look(colour(index))))
    reported = [curve for curve in learned.curves.values() if len(curve)]
    end = max([1.0, *(float(curve[-1, 0]) for curve in reported)])
    for index, (name, level) in enumerate(learned.levels.items()):
        look, line = Look(colour(len(learned.curves) + index)), LINES[(len(learned.curves) + index) % len(LINES)]
        curves.append(Curve(np.array([0.0, end]), np.full(2, level), f"{name}: {level:.3f}", line, look))
    highest = max([1.05, *(float(np.nanmedian(curve[:3, 2])) for curve in reported)])
    limits = (0.0, min(highest, 2.0))
    return Panel("", "training time, s", "J / J without control", curves, x_limits=(0.0, end), y_limits=limits)
