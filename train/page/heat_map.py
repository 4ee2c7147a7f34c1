"""Scenarios against controllers: relative cost by colour and number, failures by a cross."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from baselines import Evaluation

Array = NDArray[np.float64]

COLOURED = (0.3, 1.0)
"""log₁₀ J / J without control at which colours end, at least and at most: one that does very badly must not bleach the others."""
TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True, slots=True, eq=False)
class HeatMap:
    """How S scenarios went under C controllers. Raises ``ValueError`` for arrays of another shape."""

    scenarios: tuple[str, ...]
    controllers: tuple[str, ...]
    relative_cost: Array
    """(S, C): J over J without control; not finite where a blade failed, NaN where nothing was run."""
    failed: Array
    """(S, C): share of episodes in which the blade failed or, where that is judged, the loop was unstable."""

    def __post_init__(self) -> None:
        shape = (len(self.scenarios), len(self.controllers))
        for name in ("relative_cost", "failed"):
            value = np.shape(getattr(self, name))
            if value != shape:
                raise ValueError(f"{name} has shape {value}, but must have {shape}: scenarios by controllers.")

    @classmethod
    def of(cls, evaluations: Mapping[str, Sequence[Evaluation]]) -> HeatMap:
        """From the evaluations of each scenario; controllers are told apart by name and need not be in every scenario."""
        controllers = tuple(dict.fromkeys(each.name for row in evaluations.values() for each in row))
        relative_cost = np.full((len(evaluations), len(controllers)), np.nan)
        failed = np.zeros_like(relative_cost)
        for row, several in enumerate(evaluations.values()):
            for each in several:
                place = row, controllers.index(each.name)
                relative_cost[place], failed[place] = each.relative_cost.value, each.episodes.failed.mean()
        return cls(tuple(evaluations), controllers, relative_cost, failed)


def heat_map(content: HeatMap) -> go.Figure:
    """Blue is better than no control, red worse, in the logarithm; every cell says its number, or ✕ and the share of failures."""
    cost = np.where((content.relative_cost > 0.0) & np.isfinite(content.relative_cost), content.relative_cost, np.nan)
    reach = float(np.clip(np.nanmax(np.abs(np.log10(cost)), initial=0.0), *COLOURED))
    figure = go.Figure()
    figure.add_heatmap(
        x=content.controllers,
        y=content.scenarios,
        z=np.log10(cost),
        text=_texts(cost, content.failed),
        customdata=cost,
        texttemplate="%{text}",
        hovertemplate="%{y}<br>%{x}<br>J / J without control: %{customdata:.3f}<extra></extra>",
        hoverongaps=False,
        colorscale="RdBu",
        reversescale=True,
        zmid=0.0,
        zmin=-reach,
        zmax=reach,
        xgap=2,
        ygap=2,
        colorbar=_bar(reach),
    )
    figure.add_trace(_lost(content))
    return figure.update_layout(
        xaxis={"title": {"text": "controller"}, "type": "category", "tickangle": -35, "automargin": True, "showgrid": False},
        yaxis={"title": {"text": "scenario"}, "type": "category", "autorange": "reversed", "automargin": True, "showgrid": False},
        margin={"l": 20, "r": 10, "t": 40, "b": 20},
        showlegend=False,
    )


def _bar(reach: float) -> dict[str, Any]:
    """The key to the colours, which stand for −reach to reach of log₁₀ J / J without control."""
    ticks = [tick for tick in TICKS if abs(np.log10(tick)) <= reach]
    title = {"text": "J / J without control", "side": "right"}
    return {"title": title, "tickvals": np.log10(ticks), "ticktext": ticks, "thickness": 12}


def _texts(cost: Array, failed: Array) -> list[list[str]]:
    """The cost of each cell that has one, and the share of failures below it where there are any."""

    def text(value: float, share: float) -> str:
        if np.isnan(value):
            return ""
        return f"{value:.2f}<br>✕ {100.0 * share:.0f} %" if share > 0.0 else f"{value:.2f}"

    return [[text(*cell) for cell in zip(*row, strict=True)] for row in zip(cost, failed, strict=True)]


def _lost(content: HeatMap) -> dict[str, Any]:
    """✕ and the share of failures in cells that have no finite cost, hence no colour."""
    places = np.argwhere((content.failed > 0.0) & ~np.isfinite(content.relative_cost))
    shares = [float(content.failed[tuple(place)]) for place in places]
    return {
        "type": "scatter",
        "mode": "text",
        "x": [content.controllers[column] for _, column in places],
        "y": [content.scenarios[row] for row, _ in places],
        "text": [f"✕ {100.0 * share:.0f} %" for share in shares],
        "customdata": shares,
        "hovertemplate": "%{y}<br>%{x}<br>blade failed in %{customdata:.1%} of episodes<extra></extra>",
    }
