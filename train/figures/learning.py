"""How agents learnt, as a PNG: of a comparison, and of a training alone."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.figures.panels import LearningCurves, learning_panel
from train.figures.paper import draw_panel, handles, save, styled
from train.shared.curve import PICTURE, drawn_as, read_curve

Array = NDArray[np.float64]


def draw_learning(agents: Mapping[str, Path], folder: Path) -> None:
    """``learning.png`` of the policies in some folders, by their names; none where no training reported any progress."""
    curves = {drawn_as(name, place): read_curve(place) for name, place in agents.items()}
    if reported := with_a_cost(curves):
        save(learning_figure(reported), folder / PICTURE)


def with_a_cost(curves: Mapping[str, Array]) -> dict[str, Array]:
    """Those in which an episode has ended or somebody has looked."""
    return {name: curve for name, curve in curves.items() if np.isfinite(curve[:, 2]).any()}


def learning_figure(curves: Mapping[str, Array], levels: Mapping[str, float] = MappingProxyType({})) -> Any:
    """Cost of each agent's policy over training time, (k, 3) of seconds, steps and cost, against controllers' lines."""
    import matplotlib.pyplot as plt

    panel = learning_panel(LearningCurves(curves, {f"{name}, held-out episodes": level for name, level in levels.items()}))
    with styled():
        figure, axis = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
        draw_panel(axis, panel)
        lowest = min(float(np.nanmin(curve.y, initial=np.inf)) for curve in panel.curves)
        axis.set(ylabel=f"{panel.y_label}\nvalidation episodes, lower is better", ylim=(np.floor(9.0 * lowest) / 10.0, None))
        axis.legend(handles=handles([panel]), loc="best")
    return figure
