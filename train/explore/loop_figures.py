"""The figures of the loop: its poles, a Bode diagram and singular values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from train.explore.figures import Figure, shown
from train.explore.hertz import beside, carrier
from train.explore.loop import Loop
from train.figures.figure import Curve, Look, Panel
from train.figures.palette import NEUTRAL, PALETTE
from train.figures.panels import pole_panel

ACROSS = "frequency, rad/s"
BY_CONTROLLER = ((Look(NEUTRAL, 1.2), "solid"), (Look(PALETTE[0], 2.2), "dashed"))
"""Look and line without control and under LQG: told apart by their dashes and width too."""


def poles(loop: Loop) -> Figure:
    """Poles of the sampled loops, as their continuous equivalents."""
    highest = float(loop.frequencies[-1])
    return shown([pole_panel(loop.poles, highest)], even=False)


def bode(loop: Loop) -> Figure:
    """Magnitude and phase from one voltage to one reading."""
    magnitudes, phases = [], []
    for (name, response), (look, line) in zip(loop.bode.items(), BY_CONTROLLER, strict=True):
        magnitudes.append(Curve(loop.frequencies, np.abs(response), name, line, look))
        phases.append(Curve(loop.frequencies, np.degrees(np.unwrap(np.angle(response))), name, line, look, listed=False))
    panels = [
        Panel("", "", "full scales per drive limit", magnitudes, logarithmic=True),
        Panel("", ACROSS, "phase, °", phases),
    ]
    return over_frequency(panels, loop)


def singular_values(loop: Loop) -> Figure:
    """From voltages to readings, and from line loads to the tip."""
    own = [
        Curve(loop.frequencies, gains, "voltages to readings, each of them", "solid", Look(PALETTE[2], 1.2), listed=k == 0)
        for k, gains in enumerate(loop.plant_gains.T)
    ]
    tips = [
        Curve(loop.frequencies, 1e6 * gains, f"loads to tip, largest: {name}", line, look)
        for (name, gains), (look, line) in zip(loop.load_gains.items(), BY_CONTROLLER, strict=True)
    ]
    panels = [
        Panel("", "", "full scales per drive limit", own, logarithmic=True),
        Panel("", ACROSS, "µm per N/m", tips, logarithmic=True),
    ]
    return over_frequency(panels, loop)


def over_frequency(panels: Sequence[Panel], loop: Loop) -> Figure:
    """Panels over one logarithmic axis of frequency, with Hz above them."""
    figure = shown(list(panels), gap=0.12, even=False)
    low, high = float(loop.frequencies[0]), float(loop.frequencies[-1])
    layout: dict[str, Any] = figure["layout"]
    layout["xaxis"] |= {"type": "log", "range": [float(np.log10(low)), float(np.log10(high))], "exponentformat": "power"}
    layout["xaxis2"] = {**beside("x", low, high, logarithmic=True), "anchor": "y"}
    for name in ("yaxis", "yaxis2"):
        layout[name]["automargin"] = True
    first = panels[0].curves[0].y
    figure["data"].append(carrier("x", low, float(first[0])))
    return figure
