"""A heat map by matplotlib: relative cost by shade and number, instability by its share."""

from __future__ import annotations

from typing import Any

import numpy as np

from train.figures.heat_map import HeatMap
from train.figures.palette import DARK_IS_BAD
from train.figures.paper import STYLE, plain
from train.shared.columns import number, share

RANGE = (0.35, 2.0)
"""J / J without control between which shades differ, on a logarithmic scale: twice no control and worse is all the same dark."""
LEGEND = "bold: least J in a scenario, tier 3 aside    ▲ share of unstable episodes    ✕ not measured"


def heat_map(content: HeatMap) -> Any:
    """A Matplotlib figure; the best number of each scenario is bold."""
    import matplotlib.pyplot as plt
    from matplotlib.colors import LogNorm

    with plt.rc_context(STYLE):
        size = (2.4 + 0.74 * len(content.controllers), 1.9 + 0.46 * len(content.scenarios))
        figure, axis = plt.subplots(figsize=size, layout="constrained")
        shades = plt.get_cmap(DARK_IS_BAD).with_extremes(bad="white")
        image = axis.imshow(np.clip(content.relative_cost, *RANGE), norm=LogNorm(*RANGE), cmap=shades, aspect="auto")
        for place in np.ndindex(content.relative_cost.shape):
            _write(axis, content, *place)
        _label(axis, content)
        ticks = [0.35, 0.5, 0.7, 1.0, 1.4, 2.0]
        bar = figure.colorbar(image, ax=axis, extend="both", ticks=ticks, pad=0.01)
        bar.ax.minorticks_off()
        bar.ax.set_yticklabels([f"{tick:g}" for tick in ticks])
        bar.set_label("J / J without control")
    return figure


def _write(axis: Any, content: HeatMap, line: int, column: int) -> None:
    """The number in a cell, and below it the share of unstable episodes where there are any."""
    scenario, controller = content.scenarios[line], content.controllers[column]
    cost, unstable = content.relative_cost[line, column], content.failed[line, column]
    middle = {"ha": "center", "va": "center"}
    if np.isnan(cost):
        lost = (scenario, controller) in content.lost
        axis.text(column, line, "✕" if lost else "–", color="black" if lost else "0.5", **middle)
        return
    middle["color"] = "white" if cost > 0.85 else "black"
    weight = "bold" if content.best and content.best[line] == controller else "normal"
    axis.text(column, line - (0.16 if unstable else 0.0), number(cost, "{:.2f}"), weight=weight, **middle)
    if unstable:
        axis.text(column, line + 0.24, f"▲ {share(unstable)}", fontsize=6.5, **middle)


def _label(axis: Any, content: HeatMap) -> None:
    """Names, the kinds above their columns with lines between them, and what the marks mean."""
    axis.set_xticks(
        range(len(content.controllers)),
        [plain(name) for name in content.controllers],
        rotation=35,
        ha="right",
        rotation_mode="anchor",
    )
    axis.set_yticks(range(len(content.scenarios)), [plain(name) for name in content.scenarios])
    axis.tick_params(length=0)
    for side in axis.spines.values():
        side.set_visible(False)
    for kind in dict.fromkeys(content.kinds):
        places = [index for index, each in enumerate(content.kinds) if each == kind]
        axis.text(np.mean(places), -0.62, plain(kind), ha="center", va="bottom", fontsize=8, style="italic")
        if places[0]:
            axis.axvline(places[0] - 0.5, color="white", linewidth=3.0)
    axis.set_title(LEGEND, fontsize=8, pad=18)
