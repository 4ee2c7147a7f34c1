"""The page's figures."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.explore.blade import CAMPBELL_SPEEDS, HIGHEST_SPEED, MOTIONS, View
from train.explore.hertz import beside, carrier
from train.figures import screen
from train.figures.figure import Curve, Look, Marker, Note, Panel
from train.figures.palette import LINES, NEUTRAL, PALETTE, colour
from train.figures.panels import voltage_curves

Array = NDArray[np.float64]
Figure = dict[str, Any]

FONT = {"family": "system-ui, sans-serif", "size": 13}
SMALL = {**FONT, "size": 12}
PER_REV = (1, 2, 3, 4)
LINE_OF_TEXT = 0.05
"""Of the Campbell diagram's height."""
MOTION_LINES = ("solid", "dashed", "dashdot", "dotted")
"""Of ``MOTIONS``, the second sign besides colour."""
QUADRATURE = 0.02
"""Of the largest displacement: what moves a quarter of a period later is drawn from here on."""


def campbell_diagram(view: View) -> Figure:
    """Natural frequencies over the rotor speed, the speed's multiples, and the frequencies at the current speed."""
    top = 1.05 * float(max(view.campbell.max(), view.natural_frequencies[view.campbell.shape[1] - 1]))
    ends = np.array([0.0, HIGHEST_SPEED])
    curves = [Curve(ends, order * ends, line="dotted", look=Look(NEUTRAL, 1.0)) for order in PER_REV]
    for mode, frequencies in enumerate(view.campbell.T):
        look, name = Look(colour(mode)), f"{mode + 1} {view.families[mode]}"
        curves.append(Curve(CAMPBELL_SPEEDS, frequencies, name, LINES[mode % 2], look, listed=False, joined="smooth"))
        now, dot = np.array([view.speed]), replace(look, marker=Marker("circle"))
        curves.append(Curve(now, view.natural_frequencies[mode : mode + 1], name, "points", dot, listed=False))
    panel = Panel(
        "",
        "rotor speed, rad/s",
        "natural frequency, rad/s",
        curves,
        marked=(view.speed,),
        x_limits=(0.0, HIGHEST_SPEED),
        y_limits=(0.0, top),
        notes=[_multiple(order, top) for order in PER_REV],
    )
    figure = shown([panel])
    layout = figure["layout"]
    layout["annotations"] += _named_at_their_ends(view, top)
    layout["yaxis2"] = beside("y", 0.0, top)
    layout["margin"] = {**layout["margin"], "r": 56, "t": 12}
    figure["data"].append(carrier("y", 0.0, 0.0))
    return figure


def _multiple(order: int, top: float) -> Note:
    """Where its line leaves the diagram."""
    speed = min(HIGHEST_SPEED, top / order)
    return Note(speed, order * speed, f"{order}/rev")


def _named_at_their_ends(view: View, top: float) -> list[dict[str, Any]]:
    """Number and family above where each curve begins, those of neighbours apart."""
    starts = view.campbell[0]
    order = np.argsort(starts)
    heights, free = np.empty(len(starts)), 0.0
    for mode in order:
        heights[mode] = free = max(starts[mode], free)
        free += LINE_OF_TEXT * top
    look = {"x": 0.0, "xanchor": "left", "yanchor": "bottom", "xshift": 3, "showarrow": False, "font": SMALL}
    return [{**look, "y": float(height), "text": f"{mode + 1} {view.families[mode]}"} for mode, height in enumerate(heights)]


def mode_shape(view: View, mode: int) -> Figure:
    """One mode along the span; thin: what moves a quarter of a period later."""
    curves = []
    for motion, shape, each, line in zip(MOTIONS, view.shapes[mode], PALETTE, MOTION_LINES, strict=False):
        curves.append(Curve(view.stations, shape.real, motion, line, Look(each, 2.0)))
        if np.abs(shape.imag).max() > QUADRATURE:
            curves.append(Curve(view.stations, shape.imag, f"{motion}, ¼ period later", line, Look(each, 0.8)))
    limits = (0.0, float(view.stations[-1]))
    figure = shown([Panel("", "z, m", "relative", curves, x_limits=limits, y_limits=(-1.1, 1.1))])
    layout = figure["layout"]
    layout["xaxis"] |= {"nticks": 4}
    layout["yaxis"] |= {"tickvals": [-1, 0, 1]}
    for axis in ("xaxis", "yaxis"):
        layout[axis]["title"] |= {"standoff": 4}
    return {**figure, "layout": {**layout, "showlegend": False, "margin": {"l": 46, "r": 8, "t": 6, "b": 40}, "font": SMALL}}


def step_response(view: View) -> Figure:
    """Tip displacement in lag and flap with and without LQG, over LQG's voltages."""
    response, time = view.response, 1e3 * view.response.time
    grey, panels = Look(NEUTRAL, 1.2), []
    for row, direction in enumerate(("lag", "flap")):
        rest = np.full(2, 1e6 * response.at_rest[row])
        curves = [
            Curve(time, 1e6 * response.free[:, row], "without control", look=grey),
            Curve(time, 1e6 * response.controlled[:, row], "LQG", "dashed", Look(PALETTE[0], 2.2)),
            Curve(time[[0, -1]], rest, "at rest without control", "dotted", grey),
        ]
        panels.append(Panel("", "", f"tip in {direction}, µm", [replace(curve, listed=row == 0) for curve in curves]))
    volts = [replace(curve, joined="begins") for curve in voltage_curves(time, response.volts)]
    panels.append(Panel("", "time, ms", "LQG's voltages, V", volts, x_limits=(0.0, float(time[-1]))))
    figure = shown(panels, gap=0.12)
    for name in ("yaxis", "yaxis2", "yaxis3"):
        figure["layout"][name]["automargin"] = True
    return figure


def shown(panels: list[Panel], gap: float = 0.2, even: bool = True) -> Figure:
    """Transparent, so that the page's panels show; the page's style sheet colours text and grid by its theme.

    ``even``: whether all curves are at even intervals.
    """
    figure, clear = screen.figure(panels, compact=even, gap=gap), "rgba(0,0,0,0)"
    legend = {**screen.LEGEND, "font": SMALL}
    look = {"paper_bgcolor": clear, "plot_bgcolor": clear, "font": FONT, "legend": legend, "uirevision": "kept"}
    return {**figure, "layout": {**figure["layout"], **look}}
