"""A heat map for plotly, in the shades and with the signs that it has on paper."""

from __future__ import annotations

from typing import Any

import numpy as np
from plotly.colors import sample_colorscale

from train.figures.heat_map import LOST, QUANTITY, RANGE, SCALE, TICKS, HeatMap
from train.figures.palette import ink_on
from train.figures.screen import plain

LETTERS = 12
"""Pixels: plotly itself takes markup for letters, and makes them too small."""


def heat_map(content: HeatMap) -> dict[str, Any]:
    """Relative cost by shade and number, the share of unstable episodes below it; the best number of each scenario is bold."""
    axis = {"type": "category", "automargin": True, "showgrid": False}
    layout = {
        "xaxis": {"title": {"text": "controller"}, "tickangle": -35, **axis},
        "yaxis": {"title": {"text": "scenario"}, "autorange": "reversed", **axis},
        "margin": {"l": 20, "r": 10, "t": 40, "b": 20},
        "showlegend": False,
    }
    return {"data": [_shaded(content), _missing(content)], "layout": layout}


def _shaded(content: HeatMap) -> dict[str, Any]:
    """Cells with a cost; those that are infinite have the darkest shade."""
    cost = content.relative_cost
    return {
        "type": "heatmap",
        "x": [plain(name) for name in content.controllers],
        "y": [plain(name) for name in content.scenarios],
        "z": np.log10(np.clip(cost, *RANGE)),
        "text": [[_text(content, line, column) for column in range(cost.shape[1])] for line in range(cost.shape[0])],
        "customdata": [[text if text != "∞" else "∞: the blade fails" for text in row] for row in _numbers(content)],
        "texttemplate": "%{text}",
        "textfont": {"size": LETTERS},
        "hovertemplate": f"%{{y}}<br>%{{x}}<br>{QUANTITY}: %{{customdata}}<extra></extra>",
        "hoverongaps": False,
        "colorscale": SCALE,
        "zmin": float(np.log10(RANGE[0])),
        "zmax": float(np.log10(RANGE[1])),
        "xgap": 2,
        "ygap": 2,
        "colorbar": _bar(),
    }


def _bar() -> dict[str, Any]:
    """The key to the shades; the page says in words which way is better."""
    names = [f"≤ {TICKS[0]:g}", *(f"{tick:g}" for tick in TICKS[1:-1]), f"≥ {TICKS[-1]:g}"]
    title = {"text": QUANTITY, "side": "right"}
    return {"title": title, "tickvals": np.log10(TICKS), "ticktext": names, "thickness": 12}


def _numbers(content: HeatMap) -> list[list[str]]:
    """Costs with three decimals."""
    return [[f"{value:.3f}" if np.isfinite(value) else "∞" for value in row] for row in content.relative_cost]


def _text(content: HeatMap, line: int, column: int) -> str:
    """The cost of a cell that has one, bold if it is the best, and the share of unstable episodes below it, as its shade allows."""
    value = content.relative_cost[line, column]
    if np.isnan(value):
        return ""
    cost, unstable = content.text(line, column)
    both = "<br>".join([f"<b>{cost}</b>" if content.is_best(line, column) else cost, *([unstable] if unstable else [])])
    return f'<span style="color:{ink_on(_shade(value))}">{both}</span>'


def _shade(value: float) -> str:
    """Of a cost, "#rrggbb"."""
    low, high = np.log(RANGE)
    share = (np.log(np.clip(value, *RANGE)) - low) / (high - low)
    (shade,) = sample_colorscale(SCALE, [share], colortype="tuple")
    return "#" + "".join(f"{round(255 * part):02x}" for part in shade)


def _missing(content: HeatMap) -> dict[str, Any]:
    """Signs in cells that have no cost, hence no shade."""
    places = [(int(line), int(column)) for line, column in np.argwhere(np.isnan(content.relative_cost))]
    signs = [content.text(*place)[0] for place in places]
    return {
        "type": "scatter",
        "mode": "text",
        "x": [plain(content.controllers[column]) for _, column in places],
        "y": [plain(content.scenarios[line]) for line, _ in places],
        "text": signs,
        "customdata": ["not measured" if sign == LOST else "nothing to do there" for sign in signs],
        "hovertemplate": "%{y}<br>%{x}<br>%{customdata}<extra></extra>",
    }
