"""The comparison's figures: one episode of every controller, learning curves, closed-loop poles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines import Evaluation, LinearController, closed_loop_poles
from beamenv.plant.plant import Plant
from train.figures.figure import Curve, Look, Panel
from train.figures.palette import BEHIND, INK
from train.figures.panels import LearningCurves, learning_panel, pole_panel, voltage_curves
from train.figures.paper import STYLE, draw_panel, handles, plain, save

Array = NDArray[np.float64]


def episode_figure(evaluations: Sequence[Evaluation], episode: int) -> Any:
    """Tip displacement over voltages (the layout of thesis Fig. 5.7), a panel for each controller, no control in grey behind."""
    import matplotlib.pyplot as plt

    columns = 3
    rows = -(-len(evaluations) // columns)
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(11.0, 2.9 * rows), layout="constrained")
        cells = figure.subfigures(rows, columns, squeeze=False).ravel()
        reference = evaluations[0].reference
        largest = 1.05e6 * np.nanmax(np.abs(reference.tip_displacement[:, episode]))
        for cell, evaluation in zip(cells, evaluations, strict=False):
            tip, volts = cell.subplots(2, 1, sharex=True)
            drawn = [_tip_panel(evaluation, episode, largest), _voltage_panel(evaluation, episode)]
            for axis, panel in zip((tip, volts), drawn, strict=True):
                draw_panel(axis, panel)
            cell.suptitle(f"{plain(evaluation.name)}: J = {_relative(evaluation, episode):.3f} of no control", fontsize=9)
        for cell in cells[len(evaluations) :]:
            cell.set_facecolor("none")
        entries = handles(drawn)
        figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure


def _relative(evaluation: Evaluation, episode: int) -> float:
    return float(evaluation.judged_cost[episode] / evaluation.uncontrolled[episode])


def _tip_panel(evaluation: Evaluation, episode: int, largest: float) -> Panel:
    curves = []
    for direction, line in (("lag", "dashed"), ("flap", "solid")):
        for episodes, look, label in (
            (evaluation.reference, Look(BEHIND), "tip without control" if direction == "flap" else ""),
            (evaluation.episodes, Look(INK), f"tip, {direction}"),
        ):
            tip = 1e6 * episodes.tip_displacement[:, episode, int(direction == "flap")]
            curves.append(Curve(1e3 * evaluation.episodes.time, tip, label, line, look))
    return Panel("", "", "tip, µm", curves, y_limits=(-largest, largest))


def _voltage_panel(evaluation: Evaluation, episode: int) -> Panel:
    time = 1e3 * evaluation.episodes.time
    low, high = 1.08e-3 * evaluation.episodes.voltage_limits.T[0]
    curves = voltage_curves(time, 1e-3 * evaluation.episodes.voltages[:, episode])
    return Panel("", "time, ms", "voltage, kV", curves, x_limits=(0.0, time[-1]), y_limits=(low, high))


def learning_figure(curves: Mapping[str, Array], levels: Mapping[str, float]) -> Any:
    """Running cost of each agent over training time, (k, 3) of seconds, steps and cost, against controllers' lines."""
    import matplotlib.pyplot as plt

    panel = learning_panel(LearningCurves(curves, {f"{name}, held-out episodes": level for name, level in levels.items()}))
    with plt.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
        draw_panel(axis, panel)
        axis.set(ylabel=f"{panel.y_label}, in training or on validation seeds", ylim=(0.3, panel.y_limits[1]))
        axis.legend(handles=handles([panel]), loc="upper right")
    return figure


def pole_figure(plant: Plant, controllers: Sequence[LinearController]) -> Any:
    """Poles of the sampled loops as their continuous equivalents, upper half plane."""
    import matplotlib.pyplot as plt

    poles = {controller.name: closed_loop_poles(plant, controller) for controller in controllers}
    panel = pole_panel(poles, highest=1.08 * plant.natural_frequencies[-1])
    with plt.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
        draw_panel(axis, panel)
        axis.set_xlim(right=5.0)
        figure.legend(handles=handles([panel]), loc="outside upper center", ncols=4)
    return figure


def write_figures(
    folder: Path,
    plant: Plant,
    evaluations: Sequence[Evaluation],
    controllers: Sequence[LinearController],
    curves: Mapping[str, Array],
    levels: Mapping[str, float],
) -> None:
    """``episode.png``, ``poles.png`` and, when training reported any progress, ``learning.png``."""
    save(episode_figure(evaluations, clearest_episode(evaluations[0])), folder / "episode.png")
    save(pole_figure(plant, controllers), folder / "poles.png")
    reported = {name: curve for name, curve in curves.items() if len(curve)}
    if reported:
        save(learning_figure(reported, levels), folder / "learning.png")


def clearest_episode(evaluation: Evaluation) -> int:
    """The episode whose load lets the undriven tip swing most about where it comes to rest: it shows damping best.

    Blades that fail without control come last.
    """
    response = evaluation.reference.load_response
    swing = np.linalg.norm(response - response[-len(response) // 5 :].mean(axis=0), axis=-1)
    return int(np.argmax(np.nan_to_num(swing, nan=-1.0).max(axis=0)))
