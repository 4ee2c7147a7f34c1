"""A heat map by matplotlib: relative cost by shade and number, instability by its share."""

from __future__ import annotations

from typing import Any

import numpy as np

from train.figures.heat_map import QUANTITY, RANGE, SCALE, TICKS, WAY, HeatMap
from train.figures.palette import ink_on
from train.figures.paper import plain, styled

CELL = 0.29
"""Inches: the height of a cell, which holds two lines."""
WIDTH, LABELS, NARROWEST = 8.4, 2.3, 0.5
"""Inches: of the picture, of what stands beside the cells, and of a cell where there are so many that the picture must be wider."""
ABOVE, BETWEEN = 2.2, 0.12
"""Inches: above and below all cells, and between panels."""
SIZES = {"name": 9.5, "number": 9.5, "share": 7.5, "key": 9.0}
"""Points, at 100 of the picture's dots an inch."""


def heat_map(content: HeatMap, theme: str = "light") -> Any:
    """A Matplotlib figure, a panel for each group of scenarios below the other; the best number of each scenario is bold."""
    import matplotlib.pyplot as plt

    lines = _panels(content)
    with styled(theme):
        height = ABOVE + CELL * len(content.scenarios) + BETWEEN * (len(lines) - 1)
        width = max(WIDTH, LABELS + NARROWEST * len(content.controllers))
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
            axis.set_ylabel(plain(group), fontsize=SIZES["name"], style="italic")
            _label(axis, content, places, first=index == 0, last=index == len(lines) - 1)
        figure.align_ylabels(axes)
        bar = figure.colorbar(image, ax=axes, extend="both", ticks=TICKS, location="bottom", fraction=0.025, aspect=50, pad=0.02)
        bar.ax.minorticks_off()
        bar.ax.set_xticklabels([f"{tick:g}" for tick in TICKS])
        bar.set_label(content.key, fontsize=SIZES["key"])
        figure.text(0.012, 0.988, QUANTITY, ha="left", va="top", fontsize=11, weight="bold")
        figure.text(0.012, 0.988 - 0.22 / height, WAY, ha="left", va="top", fontsize=11)
    return figure


def _panels(content: HeatMap) -> dict[str, list[int]]:
    """Lines of each group of scenarios."""
    groups = content.groups or ("",) * len(content.scenarios)
    return {group: [line for line, each in enumerate(groups) if each == group] for group in dict.fromkeys(groups)}


def _panel(axis: Any, content: HeatMap, places: list[int]) -> Any:
    """The cells of some scenarios."""
    import matplotlib.pyplot as plt
    from matplotlib.colors import LogNorm

    shades = plt.get_cmap(SCALE).with_extremes(bad=(0.0, 0.0, 0.0, 0.0))
    shown = np.clip(content.relative_cost[places], *RANGE)
    image = axis.imshow(shown, norm=LogNorm(*RANGE), cmap=shades, aspect="auto")
    for line, column in np.ndindex(shown.shape):
        _write(axis, content, (line, places[line]), column, image)
    return image


def _write(axis: Any, content: HeatMap, lines: tuple[int, int], column: int, image: Any) -> None:
    """The number in a cell, and below it the share of unstable episodes where there are any; ``lines`` of panel and content."""
    from matplotlib.colors import to_hex

    shown, line = lines
    value, (cost, unstable) = content.relative_cost[line, column], content.text(line, column)
    middle = {"ha": "center", "va": "center", "fontsize": SIZES["number"]}
    if not np.isnan(value):
        middle["color"] = ink_on(to_hex(image.to_rgba(np.clip(value, *RANGE))))
    weight = "bold" if content.is_best(line, column) else "normal"
    axis.text(column, shown - (0.19 if unstable else 0.0), cost, weight=weight, **middle)
    if unstable:
        axis.text(column, shown + 0.26, unstable, **{**middle, "fontsize": SIZES["share"]})


def _label(axis: Any, content: HeatMap, places: list[int], first: bool, last: bool) -> None:
    """Names of scenarios; of controllers above the first panel, and of kinds, with lines between, below the last."""
    axis.set_yticks(range(len(places)), [plain(content.scenarios[line]) for line in places])
    names = [plain(name) for name in content.controllers] if first else []
    axis.set_xticks(range(len(content.controllers)) if first else [], names, rotation=35, ha="left", rotation_mode="anchor")
    axis.tick_params(length=0, labeltop=first, labelbottom=False, labelsize=SIZES["name"])
    for side in axis.spines.values():
        side.set_visible(False)
    below = {"ha": "center", "va": "top", "fontsize": SIZES["name"], "style": "italic"}
    for kind in dict.fromkeys(content.kinds):
        columns = [index for index, each in enumerate(content.kinds) if each == kind]
        if columns[0]:
            axis.axvline(columns[0] - 0.5, color=axis.get_figure().get_facecolor(), linewidth=4.0)
        if last:
            axis.text(np.mean(columns), len(places) - 0.4, plain(kind), **below)
