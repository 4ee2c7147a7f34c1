"""A heat map for plotly: relative cost by colour and number, failures by a cross."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.figures.heat_map import HeatMap
from train.figures.palette import BETTER_OR_WORSE
from train.figures.screen import plain
from train.shared.columns import share

Array = NDArray[np.float64]

COLOURED = (0.3, 1.0)
"""log₁₀ J / J without control at which colours end, at least and at most: one that does very badly must not bleach the others."""
TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


def heat_map(content: HeatMap) -> dict[str, Any]:
    """Blue is better than no control, red worse, in the logarithm; every cell says its number, or ✕ and the share of failures."""
    cost = np.where((content.relative_cost > 0.0) & np.isfinite(content.relative_cost), content.relative_cost, np.nan)
    reach = float(np.clip(np.nanmax(np.abs(np.log10(cost)), initial=0.0), *COLOURED))
    axis = {"type": "category", "automargin": True, "showgrid": False}
    layout = {
        "xaxis": {"title": {"text": "controller"}, "tickangle": -35, **axis},
        "yaxis": {"title": {"text": "scenario"}, "autorange": "reversed", **axis},
        "margin": {"l": 20, "r": 10, "t": 40, "b": 20},
        "showlegend": False,
    }
    return {"data": [_coloured(content, cost, reach), _lost(content)], "layout": layout}


def _coloured(content: HeatMap, cost: Array, reach: float) -> dict[str, Any]:
    """Cells with a finite cost."""
    return {
        "type": "heatmap",
        "x": [plain(name) for name in content.controllers],
        "y": [plain(name) for name in content.scenarios],
        "z": np.log10(cost),
        "text": _texts(cost, content.failed),
        "customdata": cost,
        "texttemplate": "%{text}",
        "hovertemplate": "%{y}<br>%{x}<br>J / J without control: %{customdata:.3f}<extra></extra>",
        "hoverongaps": False,
        "colorscale": BETTER_OR_WORSE,
        "reversescale": True,
        "zmid": 0.0,
        "zmin": -reach,
        "zmax": reach,
        "xgap": 2,
        "ygap": 2,
        "colorbar": _bar(reach),
    }


def _bar(reach: float) -> dict[str, Any]:
    """The key to the colours, which stand for −reach to reach of log₁₀ J / J without control."""
    ticks = [tick for tick in TICKS if abs(np.log10(tick)) <= reach]
    title = {"text": "J / J without control", "side": "right"}
    return {"title": title, "tickvals": np.log10(ticks), "ticktext": ticks, "thickness": 12}


def _texts(cost: Array, failed: Array) -> list[list[str]]:
    """The cost of each cell that has one, and the share of failures below it where there are any."""

    def text(value: float, part: float) -> str:
        if np.isnan(value):
            return ""
        return f"{value:.2f}<br>✕ {share(part)}" if part > 0.0 else f"{value:.2f}"

    return [[text(*cell) for cell in zip(*row, strict=True)] for row in zip(cost, failed, strict=True)]


def _lost(content: HeatMap) -> dict[str, Any]:
    """✕ and the share of failures in cells that have no finite cost, hence no colour."""
    places = np.argwhere((content.failed > 0.0) & ~np.isfinite(content.relative_cost))
    shares = [float(content.failed[tuple(place)]) for place in places]
    return {
        "type": "scatter",
        "mode": "text",
        "x": [plain(content.controllers[column]) for _, column in places],
        "y": [plain(content.scenarios[row]) for row, _ in places],
        "text": [f"✕ {share(each)}" for each in shares],
        "customdata": shares,
        "hovertemplate": "%{y}<br>%{x}<br>blade failed in %{customdata:.1%} of episodes<extra></extra>",
    }
