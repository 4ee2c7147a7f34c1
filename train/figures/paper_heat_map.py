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
TICKS = (0.35, 0.5, 0.7, 1.0, 1.4, 2.0)
LEGEND = "bold: least J of all controllers, tier 3 aside    ▲ share of unstable episodes    ✕ not measured    – nothing to do there"
CAPPED = "J / J without control; shades end at 0.35 and 2"

CELL = (0.5, 0.27)
"""Inches: a page of text is some 7.5 wide, and holds a dozen."""
MARGIN = (1.7, 1.9)
"""Inches beside and above the cells."""


def heat_map(content: HeatMap) -> Any:
    """A Matplotlib figure, a panel for each group of scenarios below the other; the best number of each scenario is bold."""
    import matplotlib.pyplot as plt

    lines = _panels(content)
    with plt.rc_context(STYLE):
        height = MARGIN[1] + CELL[1] * len(content.scenarios) + 0.3 * len(lines)
        width = max(MARGIN[0] + CELL[0] * len(content.controllers), 5.5)
        figure, axes = plt.subplots(
            len(lines),
            1,
            figsize=(width, height),
            height_ratios=[len(each) for each in lines.values()],
            layout="constrained",
            squeeze=False,
        )
        image = None
        for index, (axis, (group, places)) in enumerate(zip(axes[:, 0], lines.items(), strict=True)):
            image = _panel(axis, content, places)
            axis.set_ylabel(plain(group), fontsize=8, style="italic")
            _label(axis, content, places, first=index == 0, last=index == len(lines) - 1)
        figure.align_ylabels(axes)
        bar = figure.colorbar(image, ax=axes, extend="both", ticks=TICKS, location="bottom", fraction=0.025, aspect=50, pad=0.02)
        bar.ax.minorticks_off()
        bar.ax.set_xticklabels([f"{tick:g}" for tick in TICKS])
        bar.set_label(f"{CAPPED}\n{LEGEND}", fontsize=7.5)
    return figure


def _panels(content: HeatMap) -> dict[str, list[int]]:
    """Lines of each group of scenarios."""
    groups = content.groups or ("",) * len(content.scenarios)
    return {group: [line for line, each in enumerate(groups) if each == group] for group in dict.fromkeys(groups)}


def _panel(axis: Any, content: HeatMap, places: list[int]) -> Any:
    """The cells of some scenarios."""
    import matplotlib.pyplot as plt
    from matplotlib.colors import LogNorm

    shades = plt.get_cmap(DARK_IS_BAD).with_extremes(bad="white")
    shown = np.clip(content.relative_cost[places], *RANGE)
    image = axis.imshow(shown, norm=LogNorm(*RANGE), cmap=shades, aspect="auto")
    for line, column in np.ndindex(shown.shape):
        _write(axis, content, (line, places[line]), column)
    return image


def _write(axis: Any, content: HeatMap, lines: tuple[int, int], column: int) -> None:
    """The number in a cell, and below it the share of unstable episodes where there are any; ``lines`` of panel and content."""
    shown, line = lines
    scenario, controller = content.scenarios[line], content.controllers[column]
    cost, unstable = content.relative_cost[line, column], content.failed[line, column]
    middle = {"ha": "center", "va": "center", "fontsize": 7.5}
    if np.isnan(cost):
        lost = (scenario, controller) in content.lost
        axis.text(column, shown, "✕" if lost else "–", color="black" if lost else "0.5", **middle)
        return
    middle["color"] = "white" if cost > 0.85 else "black"
    weight = "bold" if content.best and content.best[line] == controller else "normal"
    axis.text(
        column, shown - (0.2 if unstable else 0.0), number(cost, "{:.2f}" if cost < 10.0 else "{:.0f}"), weight=weight, **middle
    )
    if unstable:
        axis.text(column, shown + 0.24, f"▲ {share(unstable)}", **{**middle, "fontsize": 6})


def _label(axis: Any, content: HeatMap, places: list[int], first: bool, last: bool) -> None:
    """Names of scenarios; of controllers above the first panel, and of kinds, with lines between, below the last."""
    axis.set_yticks(range(len(places)), [plain(content.scenarios[line]) for line in places])
    names = [plain(name) for name in content.controllers] if first else []
    axis.set_xticks(range(len(content.controllers)) if first else [], names, rotation=40, ha="left", rotation_mode="anchor")
    axis.tick_params(length=0, labeltop=first, labelbottom=False, labelsize=8)
    for side in axis.spines.values():
        side.set_visible(False)
    for kind in dict.fromkeys(content.kinds):
        columns = [index for index, each in enumerate(content.kinds) if each == kind]
        if columns[0]:
            axis.axvline(columns[0] - 0.5, color="white", linewidth=3.0)
        if last:
            axis.text(np.mean(columns), len(places) - 0.4, plain(kind), ha="center", va="top", fontsize=8, style="italic")
