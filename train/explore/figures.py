"""The page's figures, as plain dictionaries: plotly's own objects would take longer to make than the blade."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.explore.blade import CAMPBELL_SPEEDS, HIGHEST_SPEED, MOTIONS, View
from train.figures.palette import DASHES, NEUTRAL, PALETTE

Array = NDArray[np.float64]
Figure = dict[str, Any]

FONT = {"family": "system-ui, sans-serif", "size": 13}
SMALL = {**FONT, "size": 12}
LEGEND = {"orientation": "h", "x": 0.0, "y": 1.02, "xanchor": "left", "yanchor": "bottom", "font": SMALL}
MARGIN = {"l": 62, "r": 16, "t": 16, "b": 48}
PER_REV = (1, 2, 3, 4)
QUADRATURE = 0.02
"""Of the largest displacement: what moves a quarter of a period later is drawn from here on."""


def campbell_diagram(view: View) -> Figure:
    """Natural frequencies over the rotor speed, the speed's multiples, and the frequencies at the current speed."""
    top = 1.05 * float(max(view.campbell.max(), view.natural_frequencies[view.campbell.shape[1] - 1]))
    traces = []
    for mode, frequencies in enumerate(view.campbell.T):
        colour, name = PALETTE[mode], f"{mode + 1} {view.families[mode]}"
        now = view.natural_frequencies[mode : mode + 1]
        traces.append(_line(CAMPBELL_SPEEDS, frequencies, name, colour, shape="spline"))
        traces.append({**_line(np.array([view.speed]), now, name, colour), "mode": "markers", "showlegend": False})
        traces[-1]["marker"] = {"size": 9, "color": colour}
    axis = {"title": {"text": "rotor speed, rad/s"}, "range": [0.0, HIGHEST_SPEED]}
    layout = _layout(axis, {"title": {"text": "natural frequency, rad/s"}, "range": [0.0, top]})
    layout["shapes"] = [_multiple(order) for order in PER_REV] + [_upright(view.speed)]
    layout["annotations"] = [_multiple_name(order, top) for order in PER_REV]
    return {"data": traces, "layout": layout}


def _multiple(order: int) -> dict[str, Any]:
    line = {"color": NEUTRAL, "width": 1, "dash": "dot"}
    end = order * HIGHEST_SPEED
    return {"type": "line", "x0": 0.0, "y0": 0.0, "x1": HIGHEST_SPEED, "y1": end, "layer": "below", "line": line}


def _multiple_name(order: int, top: float) -> dict[str, Any]:
    """Where its line leaves the diagram."""
    speed = min(HIGHEST_SPEED, top / order)
    anchors = {"xanchor": "right", "yanchor": "top"}
    return {"x": speed, "y": order * speed, "text": f"{order}/rev", "showarrow": False, **anchors}


def _upright(speed: float) -> dict[str, Any]:
    line = {"color": NEUTRAL, "width": 1}
    return {"type": "line", "x0": speed, "x1": speed, "y0": 0, "y1": 1, "yref": "paper", "layer": "below", "line": line}


def mode_shape(view: View, mode: int) -> Figure:
    """One mode along the span; dotted: what moves a quarter of a period later."""
    traces = []
    for motion, shape, colour in zip(MOTIONS, view.shapes[mode], PALETTE, strict=False):
        traces.append(_line(view.stations, shape.real, motion, colour))
        if np.abs(shape.imag).max() > QUADRATURE:
            traces.append(_line(view.stations, shape.imag, f"{motion}, ¼ period later", colour, "dot"))
    length = float(view.stations[-1])
    layout = _layout(
        {"title": {"text": "z, m", "standoff": 4}, "range": [0.0, length], "nticks": 4},
        {"title": {"text": "relative displacement", "standoff": 4}, "range": [-1.1, 1.1], "tickvals": [-1, 0, 1]},
    )
    return {"data": traces, "layout": {**layout, "showlegend": False, "margin": {"l": 46, "r": 8, "t": 6, "b": 40}, "font": SMALL}}


def step_response(view: View) -> Figure:
    """Tip displacement in lag and flap with and without LQG, over LQG's voltages."""
    response, time = view.response, 1e3 * view.response.time
    traces = []
    for row in range(2):
        rest = np.full(2, 1e6 * response.at_rest[row])
        traces.append(_line(time, 1e6 * response.free[:, row], "without control", NEUTRAL, row=row))
        traces.append(_line(time, 1e6 * response.controlled[:, row], "LQG", PALETTE[0], row=row))
        traces.append(_line(time[[0, -1]], rest, "at rest without control", NEUTRAL, "dot", row=row))
    for patch, volts in enumerate(response.volts.T):
        traces.append(_line(time, volts, f"actuator {patch + 1}", PALETTE[patch + 1], DASHES[patch % len(DASHES)], 2, "hv"))
    for trace in traces:
        trace["showlegend"] = trace["yaxis"] != "y2"
    return {"data": traces, "layout": _panels(("tip in lag, µm", "tip in flap, µm", "LQG's voltages, V"), "time, ms", time[-1])}


def _panels(titles: tuple[str, ...], along: str, end: float) -> dict[str, Any]:
    """Panels over one another on one axis."""
    axes = ["y" if row == 0 else f"y{row + 1}" for row in range(len(titles))]
    layout = _layout({"title": {"text": along}, "range": [0.0, float(end)]}, {})
    layout["grid"] = {"rows": len(titles), "columns": 1, "subplots": [[f"x{axis}"] for axis in axes], "ygap": 0.12}
    for axis, title in zip(axes, titles, strict=True):
        layout[f"yaxis{axis[1:]}"] = {"title": {"text": title}, "automargin": True}
    return layout


def _layout(xaxis: dict[str, Any], yaxis: dict[str, Any]) -> dict[str, Any]:
    """Transparent, so that the page's panels show; the page's style sheet colours text and grid by its theme."""
    clear = "rgba(0,0,0,0)"
    layout = {"xaxis": xaxis, "yaxis": yaxis, "legend": LEGEND, "margin": MARGIN, "font": FONT, "hovermode": "closest"}
    return {**layout, "paper_bgcolor": clear, "plot_bgcolor": clear, "uirevision": "kept"}


def _line(x: Array, y: Array, name: str, colour: str, dash: str = "solid", row: int = 0, shape: str = "linear") -> dict[str, Any]:
    """A trace over evenly spaced x in a row of panels, to the five digits that a screen can show."""
    return {
        "type": "scatter",
        "mode": "lines",
        "x0": float(x[0]),
        "dx": float(x[-1] - x[0]) / max(len(x) - 1, 1),
        "y": five_digits(y),
        "yaxis": "y" if row == 0 else f"y{row + 1}",
        "name": name,
        "legendgroup": name,
        "line": {"color": colour, "dash": dash, "width": 1.6, "shape": shape},
    }


def five_digits(values: Array) -> list[float]:
    """Rounded to five digits of the largest."""
    largest = float(np.abs(values).max(initial=0.0))
    decimals = 4 - int(np.floor(np.log10(largest))) if largest > 0.0 else 0
    return np.round(values, decimals).tolist()
