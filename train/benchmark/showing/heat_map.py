"""Scenarios against controllers as a picture: relative cost by shade and number, instability by its share."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.benchmark.table import BenchmarkTable, Row
from train.figures.paper import STYLE
from train.shared.columns import number, share

Array = NDArray[np.float64]

RANGE = (0.35, 2.0)
"""J / J₀ between which shades differ, on a logarithmic scale: twice no control and worse is all the same dark."""

SHADES = "cividis_r"
"""Its lightness falls steadily: dark is bad in greyscale too, and for those who are colour-blind."""


def relative_costs(table: BenchmarkTable) -> Array:
    """(S, C): NaN where a controller has nothing to do or could not be measured."""
    rows = [[table.row(scenario, name) for name in columns(table)] for scenario in table.scenarios]
    return np.array([[row.estimates["relative_cost"].value if row and row.measured else np.nan for row in line] for line in rows])


def unstable_shares(table: BenchmarkTable) -> Array:
    """(S, C), NaN likewise."""
    rows = [[table.row(scenario, name) for name in columns(table)] for scenario in table.scenarios]
    return np.array([[row.estimates["unstable"].value if row and row.measured else np.nan for row in line] for line in rows])


def columns(table: BenchmarkTable) -> tuple[str, ...]:
    """All controllers but no control, which is 1 everywhere."""
    return tuple(name for name in table.controllers if name != "none")


def heat_map(table: BenchmarkTable) -> Any:
    """A Matplotlib figure; the least number of each scenario among what a real blade offers is bold."""
    import matplotlib.pyplot as plt
    from matplotlib.colors import LogNorm

    names, costs = columns(table), relative_costs(table)
    with plt.rc_context(STYLE):
        size = (2.4 + 0.74 * len(names), 1.9 + 0.46 * len(table.scenarios))
        figure, axis = plt.subplots(figsize=size, layout="constrained")
        shades = plt.get_cmap(SHADES).with_extremes(bad="white")
        image = axis.imshow(np.clip(costs, *RANGE), norm=LogNorm(*RANGE), cmap=shades, aspect="auto")
        for line, scenario in enumerate(table.scenarios):
            best = _best(table, scenario)
            for column, name in enumerate(names):
                _write(axis, column, line, table.row(scenario, name), name == best)
        _label(axis, table, names)
        ticks = [0.35, 0.5, 0.7, 1.0, 1.4, 2.0]
        bar = figure.colorbar(image, ax=axis, extend="both", ticks=ticks, pad=0.01)
        bar.ax.minorticks_off()
        bar.ax.set_yticklabels([f"{tick:g}" for tick in ticks])
        bar.set_label("J / J without control")
    return figure


def _write(axis: Any, column: int, line: int, row: Row | None, bold: bool) -> None:
    """The number in a cell, and below it the share of unstable episodes where there are any."""
    if row is None:
        axis.text(column, line, "–", ha="center", va="center", color="0.5")
        return
    if not row.measured:
        axis.text(column, line, "✕", ha="center", va="center", color="black")
        return
    cost, unstable = row.estimates["relative_cost"].value, row.estimates["unstable"].value
    ink = "white" if cost > 0.85 else "black"
    middle = {"ha": "center", "va": "center", "color": ink}
    axis.text(column, line - (0.16 if unstable else 0.0), number(cost, "{:.2f}"), weight="bold" if bold else "normal", **middle)
    if unstable:
        axis.text(column, line + 0.24, f"▲ {share(unstable)}", fontsize=6.5, **middle)


def _label(axis: Any, table: BenchmarkTable, names: tuple[str, ...]) -> None:
    """Names, the kinds above their columns with lines between them, and what the marks mean."""
    axis.set_xticks(range(len(names)), names, rotation=35, ha="right", rotation_mode="anchor")
    axis.set_yticks(range(len(table.scenarios)), table.scenarios)
    axis.tick_params(length=0)
    for side in axis.spines.values():
        side.set_visible(False)
    kinds = {row.controller: row.kind for row in table.rows}
    for kind in dict.fromkeys(kinds[name] for name in names):
        places = [index for index, name in enumerate(names) if kinds[name] == kind]
        axis.text(np.mean(places), -0.62, kind, ha="center", va="bottom", fontsize=8, style="italic")
        if places[0]:
            axis.axvline(places[0] - 0.5, color="white", linewidth=3.0)
    axis.set_title(
        "bold: least J in a scenario, bounds aside    ▲ share of unstable episodes    ✕ not measured", fontsize=8, pad=18
    )


def _best(table: BenchmarkTable, scenario: str) -> str:
    rows = [row for row in table.within(scenario) if row.kind != "bound" and row.measured]
    return min(rows, key=lambda row: row.mean_cost).controller if rows else ""
