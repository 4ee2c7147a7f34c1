"""The blade with its patches, over the cost of moving each of them along the span."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import build_beam
from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import INK
from train.figures.panels import actuator
from train.figures.paper import draw_panel, handles, save, styled
from train.placement.placed import PlacedSide

Array = NDArray[np.float64]

NAMES = {"actuators": "tr(P), s", "sensors": "tr(S), J"}


def draw_placement(sides: Sequence[PlacedSide], path: Path) -> None:
    """Write the picture of the sides that were placed."""
    save(placement_figure(sides), path)


def placement_figure(sides: Sequence[PlacedSide]) -> Any:
    """A column for each side: its wall with the patches, and the cost as each patch alone moves past the others."""
    import matplotlib.pyplot as plt

    with styled():
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
    beam, group = build_beam(config), config.patches.only(side.placement.side)
    span, width = beam.length, group.width
    z = np.unique([0.0, span, *(piece.start for piece in beam.planform.pieces)])
    half = 1e3 * 0.5 * beam.section.wall_width(group.wall) * beam.planform.scale(z)
    axis.fill(np.append(z, z[::-1]), np.append(half, -half[::-1]), facecolor="0.93", edgecolor="black", linewidth=0.8)
    for start in bounds.uniform():
        axis.add_patch(Rectangle((start, -500.0 * width), bounds.length, 1e3 * width, fill=False, edgecolor="0.5", linestyle=":"))
    for index, start in enumerate(side.placement.positions):
        filled: dict[str, Any] = {"facecolor": actuator(index)[0].colour, "edgecolor": "black", "linewidth": 0.5}
        axis.add_patch(Rectangle((start, -500.0 * width), bounds.length, 1e3 * width, **filled))
        axis.text(start + 0.5 * bounds.length, 900.0 * width, str(index + 1), ha="center", va="center")
    title = f"{side.placement.side}, {group.wall} wall, {config.speed:g} rad/s (dotted: equally spaced)"
    axis.set(
        title=title,
        ylabel="chord, mm",
        xlim=(-0.02 * span, 1.02 * span),
        ylim=1.15 * half.max() * np.array([-1.0, 1.0]),
    )


def _draw_cost(axis: Any, side: PlacedSide) -> None:
    panel = _cost_panel(side)
    draw_panel(axis, panel)
    low, high = axis.get_ylim()
    if high > 3.0 * low:  # the valleys of weak patches would not be seen beside the cliffs of a strong one
        axis.set_yscale("log")
    axis.legend(handles=handles([panel]), ncols=2)


def _cost_panel(side: PlacedSide) -> Panel:
    """Cost over the position of each patch, with a dot where it is, and the cost of equal spacing."""
    curves = []
    for index, start in enumerate(side.placement.positions):
        where, cost = cost_along_span(side, index)
        look, line = actuator(index)
        curves.append(Curve(where, cost, f"patch {index + 1} moved", line, look))
        dot = replace(look, marker=Marker("circle", size=4))
        curves.append(Curve(np.array([start]), np.array([side.placement.cost]), line="points", look=dot))
    ends = np.array([-0.02, 1.02]) * side.problem.config.beam.length
    level = Look(INK, width=0.7)
    curves.append(Curve(ends, np.full(2, side.uniform_cost), "equally spaced", "dashdot", level))
    return Panel("", "root-side edge, m from the root", NAMES[side.placement.side], curves, x_limits=tuple(ends.tolist()))


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
