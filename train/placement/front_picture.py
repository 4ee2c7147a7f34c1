"""The trade-off between what a closed loop costs and what its patches weigh, and the patches of every point of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import INK, PALETTE, SIGNS
from train.figures.paper import draw_panel, handles, save, styled
from train.figures.patches import patches_panel
from train.placement.sized import SizedFront

Array = NDArray[np.float64]


def draw_front(sized: SizedFront, path: Path) -> None:
    """Write the picture."""
    import matplotlib.pyplot as plt

    panels = front_panels(sized)
    with styled():
        figure, axes = plt.subplots(1, 2, figsize=(11.0, 4.2), layout="constrained")
        for axis, panel in zip(axes, panels, strict=True):
            draw_panel(axis, panel)
            axis.legend(handles=handles([panel]), loc="best")
        save(figure, path)


def front_panels(sized: SizedFront) -> list[Panel]:
    """Cost over mass, and the span with every point's patches at its mass."""
    return [cost_panel(sized), patches_panel(sized.front.points, sized.problem.config.beam.length)]


def cost_panel(sized: SizedFront) -> Panel:
    """The front, on the plants of its points too, and the blade's own patches on the same axes."""
    mass = np.array([each.mass for each in sized.front.points])
    cost = np.array([each.cost for each in sized.front.points])
    curves = [
        Curve(1e3 * mass, 1e6 * cost, "sized and placed", look=Look(INK, marker=Marker("circle", size=3.5)), joined="begins"),
        Curve(
            1e3 * mass,
            1e6 * np.array(sized.on_plants),
            "… on the plant of each",
            "points",
            Look(INK, marker=Marker("x-thin", size=4)),
        ),
    ]
    for k, each in enumerate(sized.layouts):
        look = Look(PALETTE[k + 1], marker=Marker(SIGNS[2 + k], size=6, fill="none"), above=True)
        curves.append(Curve(np.array([1e3 * each.mass]), np.array([1e6 * each.cost]), f"own size, {each.name}", "points", look))
    title = f"Patches of a blade at {sized.problem.config.speed:g} rad/s"
    return Panel(title, "mass of piezo sheet, g", "stationary cost of LQG, µJ", curves, logarithmic=True, x_logarithmic=True)
