"""The page's figures."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.explore.blade import MOTIONS, View
from train.explore.hertz import beside, carrier
from train.explore.units import Unit, angular, unit_of
from train.figures import screen
from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import LINES, NEUTRAL, PALETTE, colour
from train.figures.panels import voltage_curves

Array = NDArray[np.float64]
Figure = dict[str, Any]

FONT = {"family": "system-ui, sans-serif", "size": 13}
SMALL = {**FONT, "size": 12}
PER_REV = (1, 2, 3, 4)
LINE_OF_TEXT, ROOM_ACROSS = 0.042, 0.14
"""Of the Campbell diagram's height, and of its width."""
STILL = 1e-6
"""Of the other direction's largest displacement: what moves less is drawn at rest."""
LEGEND_COLUMNS, LEGEND_ROW = 2, 20
"""At the narrowest; pixels."""
MOTION_LINES = ("solid", "dashed", "dashdot", "dotted")
"""Of ``MOTIONS``, the second sign besides colour."""
QUADRATURE = 0.02
"""Of the largest displacement: what moves a quarter of a period later is drawn from here on."""


def campbell_diagram(view: View) -> Figure:
    """Natural frequencies over the rotor speed, the speed's multiples, and the frequencies at the current speed."""
    highest, largest = float(view.speeds[-1]), float(max(view.campbell.max(), view.natural_frequencies[view.campbell.shape[1] - 1]))
    (unit, cycles), top = angular(largest), 1.05 * largest
    ends = np.array([0.0, highest])
    curves = [Curve(ends, unit.per * order * ends, line="dotted", look=Look(NEUTRAL, 1.0)) for order in PER_REV]
    for mode, frequencies in enumerate(view.campbell.T):
        look, name = Look(colour(mode)), f"{mode + 1} {view.families[mode]}"
        curves.append(Curve(view.speeds, unit.per * frequencies, name, LINES[mode % 4], look, listed=False, joined="smooth"))
        now, dot = np.array([view.speed]), replace(look, marker=Marker("circle"))
        curves.append(Curve(now, unit.per * view.natural_frequencies[mode : mode + 1], name, "points", dot, listed=False))
    panel = Panel(
        "",
        "rotor speed, rad/s",
        f"natural frequency, {unit.name}",
        curves,
        marked=(view.speed,),
        x_limits=(0.0, highest),
        y_limits=(0.0, unit.per * top),
    )
    figure = shown([panel])
    layout = figure["layout"]
    layout["annotations"] += [*_named_at_their_ends(view, top, unit), *_multiples(highest, top, unit)]
    layout["yaxis2"] = beside("y", 0.0, top, unit=unit, cycles=cycles)
    layout["margin"] = {**layout["margin"], "r": 60, "t": 12}
    figure["data"].append(carrier("y", 0.0, 0.0))
    return figure


def _multiples(highest: float, top: float, unit: Unit) -> list[dict[str, Any]]:
    """A name where a multiple of the speed leaves the diagram, from the steepest on; none where another is too near."""
    found: list[tuple[float, float, int]] = []
    for order in reversed(PER_REV):
        speed = min(highest, top / order)
        across, up = speed / highest, order * speed / top
        if all(abs(across - x) > ROOM_ACROSS or abs(up - y) > LINE_OF_TEXT for x, y, _ in found):
            found.append((across, up, order))
    look = {"xanchor": "right", "yanchor": "top", "showarrow": False, "font": SMALL}
    return [{**look, "x": x * highest, "y": unit.per * y * top, "text": f"{order}/rev"} for x, y, order in found]


def _named_at_their_ends(view: View, top: float, unit: Unit) -> list[dict[str, Any]]:
    """Number and family where each curve begins; of those that begin too near to one another side by side."""
    starts, lines = view.campbell[0], list[list[int]]()
    for mode in np.argsort(starts, kind="stable").tolist():
        if lines and starts[mode] - starts[lines[-1][0]] < LINE_OF_TEXT * top:
            lines[-1].append(mode)
        else:
            lines.append([mode])
    look = {"x": 0.0, "xanchor": "left", "yanchor": "bottom", "xshift": 3, "showarrow": False, "font": SMALL}
    return [
        {
            **look,
            "y": unit.per * float(starts[modes[-1]]),
            "text": ", ".join(f"{mode + 1} {view.families[mode]}" for mode in sorted(modes)),
        }
        for modes in lines
    ]


def mode_shape(view: View, mode: int) -> Figure:
    """One mode along the span; thin: what moves a quarter of a period later."""
    curves = []
    for motion, shape, each, line in zip(MOTIONS, view.shapes[mode], PALETTE, MOTION_LINES, strict=False):
        curves.append(Curve(view.stations, shape.real, motion, line, Look(each, 2.0)))
        if np.abs(shape.imag).max() > QUADRATURE:
            curves.append(Curve(view.stations, shape.imag, f"{motion}, ¼ period later", line, Look(each, 0.8)))
    metres = unit_of(view.stations, "m")
    curves = [replace(curve, x=metres.per * curve.x) for curve in curves]
    limits = (0.0, metres.per * float(view.stations[-1]))
    figure = shown([Panel("", f"z, {metres.name}", "relative", curves, x_limits=limits, y_limits=(-1.1, 1.1))])
    layout = figure["layout"]
    layout["xaxis"] |= {"nticks": 4}
    layout["yaxis"] |= {"tickvals": [-1, 0, 1]}
    for axis in ("xaxis", "yaxis"):
        layout[axis]["title"] |= {"standoff": 4}
    return {**figure, "layout": {**layout, "showlegend": False, "margin": {"l": 46, "r": 10, "t": 6, "b": 40}, "font": SMALL}}


def step_response(view: View) -> Figure:
    """Tip displacement in lag and flap with and without LQG, over LQG's voltages."""
    response = view.response
    seconds, grey, panels = unit_of(response.time, "s"), Look(NEUTRAL, 1.2), []
    time, moves = seconds.per * response.time, np.stack([response.free, response.controlled])
    for row, direction in enumerate(("lag", "flap")):
        still = np.abs(moves[..., row]).max() <= STILL * np.abs(moves).max()
        unit = unit_of(moves if still else moves[..., row], "m")
        rest = np.full(2, unit.per * response.at_rest[row])
        curves = [
            Curve(time, unit.per * response.free[:, row], "without control", look=grey),
            Curve(time, unit.per * response.controlled[:, row], "LQG", "dashed", Look(PALETTE[0], 2.2)),
            Curve(time[[0, -1]], rest, "at rest without control", "dotted", grey),
        ]
        limits = (-1.0, 1.0) if still else (None, None)
        named = [replace(curve, listed=row == 0) for curve in curves]
        panels.append(Panel("", "", f"{direction}, {unit.name}", named, y_limits=limits))
    volts = unit_of(np.minimum(np.abs(response.volts), 1.0), "V")
    driven = [replace(curve, joined="begins") for curve in voltage_curves(time, volts.per * response.volts)]
    panels.append(Panel("", f"time, {seconds.name}", f"voltage, {volts.name}", driven, x_limits=(0.0, float(time[-1]))))
    figure = shown(panels, gap=0.12)
    return with_room_for_its_legend(figure)


def with_room_for_its_legend(figure: Figure, further: float = 0.0) -> Figure:
    """The legend over all, and as much room above the panels as it takes, and ``further`` pixels."""
    entries = {each["name"] for each in figure["data"] if each.get("showlegend")}
    rows = -(-len(entries) // LEGEND_COLUMNS)
    layout = figure["layout"]
    legend = {**layout["legend"], "yref": "container", "y": 1.0, "yanchor": "top"}
    return {**figure, "layout": {**layout, "legend": legend, "margin": {**layout["margin"], "t": 10 + LEGEND_ROW * rows + further}}}


def shown(panels: list[Panel], gap: float = 0.2, even: bool = True) -> Figure:
    """Transparent, so that the page's panels show; the page's style sheet colours text and grid by its theme.

    ``even``: whether all curves are at even intervals.
    """
    figure, clear = screen.figure(panels, compact=even, gap=gap), "rgba(0,0,0,0)"
    legend = {**screen.LEGEND, "font": SMALL}
    look = {"paper_bgcolor": clear, "plot_bgcolor": clear, "font": FONT, "legend": legend, "uirevision": "kept"}
    axes = {name: _axis(name, axis) for name, axis in figure["layout"].items() if name[1:5] == "axis"}
    return {**figure, "layout": {**figure["layout"], **axes, **look}}


def _axis(name: str, axis: dict[str, Any]) -> dict[str, Any]:
    """Its title clear of its ticks, which have no prefixes: those stand in the title."""
    plain = {} if axis.get("type") == "log" else {"exponentformat": "none", "separatethousands": False}
    apart = {"automargin": True} if name[0] == "y" else {}
    return {**axis, **plain, **apart, "title": {**axis["title"], "standoff": 8}}
