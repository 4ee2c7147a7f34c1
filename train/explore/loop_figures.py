"""The figures of the loop: its poles, a Bode diagram and singular values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from train.explore.figures import Figure, shown
from train.explore.hertz import beside, carrier
from train.explore.loop import Array, Complex, Loop
from train.figures.figure import Curve, Look, Panel
from train.figures.palette import NEUTRAL, PALETTE
from train.figures.panels import pole_panel

ACROSS = "frequency, rad/s"
HALF_A_TURN = 180.0
MOST_TICKS = 4
"""Of a logarithmic axis, about."""
BY_CONTROLLER = ((Look(NEUTRAL, 1.2), "solid"), (Look(PALETTE[0], 2.2), "dashed"))
"""Look and line without control and under LQG: told apart by their dashes and width too."""


def poles(loop: Loop) -> Figure:
    """Poles of the sampled loops, as their continuous equivalents."""
    return shown([pole_panel(loop.poles)], even=False)


def bode(loop: Loop) -> Figure:
    """Magnitude and phase from one voltage to one reading."""
    magnitudes, phases = [], []
    for (name, response), (look, line) in zip(loop.bode.items(), BY_CONTROLLER, strict=True):
        magnitudes.append(Curve(loop.frequencies, np.abs(response), name, line, look))
        phases.append(Curve(loop.frequencies, _phase(response), name, line, look, listed=False))
    panels = [
        Panel("", "", "reading per voltage", magnitudes, logarithmic=True),
        Panel("", ACROSS, "phase, °", phases, y_limits=(-HALF_A_TURN, HALF_A_TURN)),
    ]
    figure = over_frequency(panels, loop)
    figure["layout"]["yaxis2"] |= {"tickvals": [-180, -90, 0, 90, 180]}
    return figure


def _phase(response: Complex) -> Array:
    """Degrees from −180 to 180, with a gap where it passes from one to the other: many zeros are too sharp to tell how often."""
    phase = np.degrees(np.angle(response))
    phase[np.flatnonzero(np.abs(np.diff(phase)) > HALF_A_TURN)] = np.nan
    return phase


def singular_values(loop: Loop) -> Figure:
    """From voltages to readings, and from line loads to the tip."""
    own = [
        Curve(loop.frequencies, gains, "voltages to readings", "solid", BY_CONTROLLER[0][0], listed=False)
        for gains in loop.plant_gains.T
    ]
    tips = [
        Curve(loop.frequencies, 1e6 * gains, name, line, look)
        for (name, gains), (look, line) in zip(loop.load_gains.items(), BY_CONTROLLER, strict=True)
    ]
    panels = [
        Panel("", "", "readings per voltages", own, logarithmic=True),
        Panel("", ACROSS, "tip per load, µm m/N", tips, logarithmic=True),
    ]
    return over_frequency(panels, loop)


def over_frequency(panels: Sequence[Panel], loop: Loop) -> Figure:
    """Panels over one logarithmic axis of frequency, with Hz above them."""
    figure = shown(list(panels), gap=0.12, even=False)
    low, high = float(loop.frequencies[0]), float(loop.frequencies[-1])
    layout: dict[str, Any] = figure["layout"]
    decades = {"type": "log", "dtick": 1, "minor": {"showgrid": True}, "exponentformat": "none"}
    layout["xaxis"] |= {**decades, "range": [float(np.log10(low)), float(np.log10(high))]}
    layout["xaxis2"] = {**beside("x", low, high, logarithmic=True), "anchor": "y"}
    for name, panel in zip(("yaxis", "yaxis2"), panels, strict=True):
        layout[name] |= {"automargin": True} | ({"dtick": _decades_a_tick(panel)} if panel.logarithmic else {})
    layout["margin"] = {**layout["margin"], "t": 76}
    layout["legend"] = {**layout["legend"], "yref": "container", "y": 1.0, "yanchor": "top"}
    first = panels[0].curves[0].y
    figure["data"].append(carrier("x", low, float(first[0])))
    return figure


def _decades_a_tick(panel: Panel) -> int:
    values = np.concatenate([curve.y[curve.y > 0.0] for curve in panel.curves])
    return max(1, round(float(np.ptp(np.log10(values))) / MOST_TICKS)) if len(values) else 1
