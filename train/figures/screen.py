"""Figures for plotly, as plain dictionaries: plotly's own objects take longer to make than a blade."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.figures.figure import Curve, Limits, Panel
from train.figures.palette import NEUTRAL
from train.shared.files import on_one_line

Array = NDArray[np.float64]

DASHES = {"solid": "solid", "dashed": "dash", "dotted": "dot", "dashdot": "dashdot", "bars": "solid"}
SHAPES = {"straight": "linear", "smooth": "spline", "ends": "vh", "begins": "hv"}
LEGEND = {"orientation": "h", "x": 0.0, "y": 1.02, "xanchor": "left", "yanchor": "bottom"}
MARGIN = {"l": 62, "r": 16, "t": 16, "b": 48}
WIDTH, BAR, SIGN_SIZE = 1.5, 5.0, 9.0
TICKS = np.array([-10000.0, -1000.0, -100.0, -10.0, 0.0, 10.0, 100.0, 1000.0])
"""Of an axis that is logarithmic on both sides."""


def plain(text: str) -> str:
    """Text that is shown as it stands: plotly takes tags in any text for markup, links among them."""
    return escape(on_one_line(text), quote=False)


def single(values: Array) -> NDArray[np.float32]:
    """Single precision, which is finer than any screen."""
    return np.asarray(values, dtype=np.float32)


def five_digits(values: Array) -> list[float]:
    """Rounded to five digits of the largest."""
    largest = float(np.abs(values).max(initial=0.0))
    decimals = 4 - int(np.floor(np.log10(largest))) if largest > 0.0 else 0
    return np.round(values, decimals).tolist()


def symmetric_logarithm(values: Array, within: float) -> Array:
    """sign(x) log₁₀(1 + |x|/within): close to linear about 0, where slow poles tell apart stable from unstable."""
    return np.asarray(np.sign(values) * np.log10(1.0 + np.abs(values) / within))


def figure(panels: Sequence[Panel], compact: bool = False, gap: float = 0.2) -> dict[str, Any]:
    """Panels over one another that share the x axis of the last, so that they zoom and are read off together.

    ``compact`` is for curves at even intervals, whose numbers are written with five digits; ``gap`` is between panels, as a share
    of their height.
    """
    traces = [trace(curve, panel, row, compact) for row, panel in enumerate(panels, start=1) for curve in panel.curves]
    layout = {
        "xaxis": x_axis(panels[-1]),
        **{f"yaxis{_suffix(row)}": y_axis(panel) for row, panel in enumerate(panels, start=1)},
        "shapes": [_upright(x, panel) for panel in panels for x in panel.marked],
        "annotations": [note for row, panel in enumerate(panels, start=1) for note in _notes(panel, row)],
        "legend": LEGEND,
        "margin": MARGIN,
        "hovermode": "closest",
    }
    if len(panels) > 1:
        subplots = [[f"xy{_suffix(row)}"] for row in range(1, len(panels) + 1)]
        layout["grid"] = {"rows": len(panels), "columns": 1, "subplots": subplots, "ygap": gap}
    return {"data": traces, "layout": layout}


def trace(curve: Curve, panel: Panel, row: int, compact: bool = False) -> dict[str, Any]:
    """A curve in a row of panels; a label has one entry in the legend, which switches all curves that bear it."""
    look = curve.look
    drawn: dict[str, Any] = {
        "type": "scatter",
        "mode": "markers" if curve.line == "points" else "lines",
        **_abscissae(curve, panel, compact),
        "y": five_digits(curve.y) if compact else single(curve.y),
        "yaxis": f"y{_suffix(row)}",
        "name": plain(curve.label),
        "legendgroup": plain(curve.label),
        "showlegend": bool(curve.label) and curve.listed,
    }
    if curve.line != "points":
        width = look.width or (BAR if curve.line == "bars" else WIDTH)
        drawn["line"] = {"color": look.colour, "dash": DASHES[curve.line], "width": width, "shape": SHAPES[curve.joined]}
    if look.marker is not None:
        drawn["marker"] = _marker(curve)
    if not curve.label:
        drawn["hoverinfo"] = "skip"
    return drawn


def _abscissae(curve: Curve, panel: Panel, compact: bool) -> dict[str, Any]:
    """As they are; beside them, those of an axis that is logarithmic on both sides as they are read off."""
    if compact:
        return {"x0": float(curve.x[0]), "dx": float(curve.x[-1] - curve.x[0]) / max(len(curve.x) - 1, 1)}
    if panel.x_linear_within is None:
        return {"x": single(curve.x)}
    read_off = {"customdata": curve.x, "hovertemplate": "%{customdata:.1f} + %{y:.1f} j rad/s", "cliponaxis": False}
    return {"x": symmetric_logarithm(curve.x, panel.x_linear_within), **read_off}


def _marker(curve: Curve) -> dict[str, Any]:
    colour, marker = curve.look.colour, curve.look.marker
    assert marker is not None
    thin = marker.sign.endswith("-thin")
    sign = {"point": "circle"}.get(marker.sign, marker.sign) + ("-open" if marker.fill == "none" and not thin else "")
    size = SIGN_SIZE if marker.size is None else marker.size
    return {"symbol": sign, "size": size, "color": colour, "line": {"width": 2 if marker.fill == "none" else 0, "color": colour}}


def x_axis(panel: Panel) -> dict[str, Any]:
    """With label, limits and, where it is logarithmic on both sides, its ticks."""
    axis: dict[str, Any] = {"title": {"text": plain(panel.x_label)}, **_range(panel.x_limits)}
    if panel.x_logarithmic:
        axis |= {"type": "log"}
    if panel.x_linear_within is not None:
        names = [f"{tick:g}".replace("-", "−") for tick in TICKS]
        axis |= {"tickvals": symmetric_logarithm(TICKS, panel.x_linear_within), "ticktext": names, "zeroline": False}
    return axis


def y_axis(panel: Panel) -> dict[str, Any]:
    """With label, limits and scale."""
    scale = {"type": "log", "exponentformat": "power"} if panel.logarithmic else {}
    names = {"tickvals": [*range(1, len(panel.y_names) + 1)], "ticktext": [plain(name) for name in panel.y_names]}
    return {"title": {"text": plain(panel.y_label)}, **_range(panel.y_limits), **scale, **(names if panel.y_names else {})}


def _range(limits: Limits) -> dict[str, Any]:
    low, high = limits
    if low is not None and high is not None:
        return {"range": [low, high]}
    return {"rangemode": "tozero"} if low == 0.0 else {}


def upright(x: float, **line: Any) -> dict[str, Any]:
    """A line through all panels."""
    return {"type": "line", "x0": x, "x1": x, "y0": 0, "y1": 1, "yref": "paper", "layer": "below", "line": line}


def _upright(x: float, panel: Panel) -> dict[str, Any]:
    place = x if panel.x_linear_within is None else float(symmetric_logarithm(np.array(x), panel.x_linear_within))
    return upright(place, color=NEUTRAL, width=1, dash=DASHES[panel.marked_line])


def _notes(panel: Panel, row: int) -> list[dict[str, Any]]:
    """The panel's title above it, then its notes."""
    above = {"xref": "paper", "x": 0.0, "xanchor": "left", "y": 1.0, "yanchor": "bottom", "showarrow": False}
    title = [{**above, "text": plain(panel.title), "yref": f"y{_suffix(row)} domain"}] if panel.title else []
    beside = {"showarrow": False, "xanchor": "right", "yanchor": "top", "yref": f"y{_suffix(row)}"}
    return title + [{"x": note.x, "y": note.y, "text": plain(note.text), **beside} for note in panel.notes]


def _suffix(row: int) -> str:
    return "" if row == 1 else str(row)
