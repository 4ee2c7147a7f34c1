"""The blade with its patches, over the cost of moving each of them along the span."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.figures.paper import STYLE, VOLTAGE_LINES, save
from train.placement.placed import PlacedSide

Array = NDArray[np.float64]

WALLS = {"actuators": "top wall", "sensors": "bottom wall"}
NAMES = {"actuators": "tr(P), s", "sensors": "tr(S), J"}


def draw_placement(sides: Sequence[PlacedSide], path: Path) -> None:
    """Write the picture of the sides that were placed."""
    save(placement_figure(sides), path)


def placement_figure(sides: Sequence[PlacedSide]) -> Any:
    """A column for each side: its wall with the patches, and the cost as each patch alone moves past the others."""
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(
            2,
            len(sides),
            figsize=(6.2 * len(sides), 4.6),
            height_ratios=(1, 2.6),
            sharex="col",
            squeeze=False,
            layout="constrained",
        )
        for (wall, cost), side in zip(axes.T, sides, strict=True):
            _draw_wall(wall, side)
            _draw_cost(cost, side)
    return figure


def _draw_wall(axis: Any, side: PlacedSide) -> None:
    """The wall seen from outside, chord to scale with itself alone."""
    from matplotlib.patches import Rectangle

    config, bounds = side.problem.config, side.problem.bounds
    span, root_chord = config.beam.length, config.beam.width
    tip_chord, width = root_chord / config.beam.taper, config.patches.width
    chord = 1e3 * 0.5 * np.array([root_chord, tip_chord, -tip_chord, -root_chord])
    axis.fill([0.0, span, span, 0.0], chord, facecolor="0.93", edgecolor="black", linewidth=0.8)
    for start in bounds.uniform():
        axis.add_patch(Rectangle((start, -500.0 * width), bounds.length, 1e3 * width, fill=False, edgecolor="0.5", linestyle=":"))
    for number, (start, (colour, _)) in enumerate(zip(side.placement.positions, VOLTAGE_LINES * 8, strict=False), start=1):
        axis.add_patch(
            Rectangle((start, -500.0 * width), bounds.length, 1e3 * width, facecolor=colour, edgecolor="black", linewidth=0.5)
        )
        axis.text(start + 0.5 * bounds.length, 900.0 * width, str(number), ha="center", va="center")
    title = f"{side.placement.side}, {WALLS[side.placement.side]}, {config.speed:g} rad/s (dotted: equally spaced)"
    axis.set(
        title=title,
        ylabel="chord, mm",
        xlim=(-0.02 * span, 1.02 * span),
        ylim=1.15 * chord[[2, 0]] if tip_chord > root_chord else 1.15 * chord[[3, 0]],
    )


def _draw_cost(axis: Any, side: PlacedSide) -> None:
    bounds, layout = side.problem.bounds, np.array(side.placement.positions)
    for number, (colour, dashes) in zip(range(bounds.count), VOLTAGE_LINES * 8, strict=False):
        where, cost = cost_along_span(side, number)
        axis.plot(where, cost, color=colour, linestyle=dashes, label=f"patch {number + 1} moved")
        axis.plot(layout[number], side.placement.cost, marker="o", color=colour, markersize=4)
    axis.axhline(side.uniform_cost, color="black", linestyle=(0, (8, 3, 1, 3)), linewidth=0.7, label="equally spaced")
    axis.set(xlabel="root-side edge, m from the root", ylabel=NAMES[side.placement.side])
    low, high = axis.get_ylim()
    if high > 3.0 * low:  # the valleys of weak patches would not be seen beside the cliffs of a strong one
        axis.set_yscale("log")
    axis.legend(ncols=2)


def cost_along_span(side: PlacedSide, number: int, points: int = 161) -> tuple[Array, Array]:
    """Positions (points,) of one patch, and the cost with the others in place; NaN where it would overlap one of them."""
    bounds, layout = side.problem.bounds, np.array(side.placement.positions)
    where = np.linspace(bounds.low, bounds.high, points)
    others = np.delete(layout, number)
    free = np.all(np.abs(where[:, None] - others) >= bounds.length, axis=1)
    cost = np.full(points, np.nan)
    layouts = np.column_stack([np.tile(others, (int(free.sum()), 1)), where[free]])
    cost[free] = side.problem.cost(layouts)
    return where, cost
